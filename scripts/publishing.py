"""What the scripts that write reports/published share: batches and their runs, trajectories, poses."""
import bisect
import json
import math
import pathlib
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = "build/release/apps/traverse/traverse"


def commit():
    return subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=12"], cwd=ROOT, check=True,
                          capture_output=True, text=True).stdout.strip()


def batch(plan, out, *options):
    """Runs a plan, or what is not finished of it, and returns its runs by recording and variant. Runs that are not
    ok are rows too, so the batch's own exit status says nothing here."""
    words = [PROGRAM, "batch", str(plan), "-o", str(out), *options]
    print(shlex.join(words), file=sys.stderr)
    subprocess.run(words, cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
    results = json.loads((ROOT / out / "results.json").read_text())
    if any(run["outcome"] is None for run in results["runs"]):
        sys.exit(f"{out}: not all runs are made; the same command goes on")
    return {(run["recording"], run["variant"]): run for run in results["runs"]}


def folder_of(out, run):
    return ROOT / out / run["folder"]


def beside_recording(out, name, ending):
    """A file that the batch's generated recording `name` has beside it: ".rig.yaml"."""
    return next((ROOT / out / "recordings").glob(f"{name}-*/{name}{ending}"))


def markdown(out):
    """The tables of a plan, and the sentence that says how they were made."""
    return (ROOT / out / "tables.md").read_text()


def write(name, lines):
    (ROOT / "reports/published" / name).write_text("\n".join(lines) + "\n")


def rows_of(tum):
    return [[float(word) for word in line.split()] for line in tum.read_text().splitlines()
            if line and not line.startswith("#")]


def pose(x, y, z, qx, qy, qz, qw):
    """(R, t)"""
    n = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
    a, b, c, w = qx / n, qy / n, qz / n, qw / n
    return ([[1 - 2 * (b * b + c * c), 2 * (a * b - c * w), 2 * (a * c + b * w)],
             [2 * (a * b + c * w), 1 - 2 * (a * a + c * c), 2 * (b * c - a * w)],
             [2 * (a * c - b * w), 2 * (b * c + a * w), 1 - 2 * (a * a + b * b)]], [x, y, z])


def times(A, B):
    (Ra, ta), (Rb, tb) = A, B
    return ([[sum(Ra[i][k] * Rb[k][j] for k in range(3)) for j in range(3)] for i in range(3)],
            [sum(Ra[i][k] * tb[k] for k in range(3)) + ta[i] for i in range(3)])


def inverse(A):
    R, t = A
    Rt = [[R[j][i] for j in range(3)] for i in range(3)]
    return Rt, [-sum(Rt[i][k] * t[k] for k in range(3)) for i in range(3)]


def angle_deg(R):
    return math.degrees(math.acos(max(-1.0, min(1.0, (R[0][0] + R[1][1] + R[2][2] - 1) / 2))))


def by_stamp(tum):
    """Poses by the text of their stamps."""
    lines = [line.split() for line in tum.read_text().splitlines() if line and not line.startswith("#")]
    return {words[0]: pose(*map(float, words[1:8])) for words in lines}


def seen_from(T, position):
    """A position in the frame of a pose."""
    return times(inverse(T), ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], position))[1]


class Trajectory:
    """Poses by their stamps; of the truth of a simulated drive, say."""

    def __init__(self, tum):
        rows = rows_of(tum)
        self.stamps = [row[0] for row in rows]
        self.poses = [pose(*row[1:8]) for row in rows]

    def at(self, stamp):
        """The pose of that stamp to 0.1 ms."""
        return self.poses[bisect.bisect_left(self.stamps, stamp - 1e-4)]

    def near(self, stamp, seconds=2e-3):
        """The pose of that stamp; None where there is none so near."""
        k = bisect.bisect_left(self.stamps, stamp - 1e-4)
        return self.poses[k] if k < len(self.stamps) and abs(self.stamps[k] - stamp) < seconds else None
