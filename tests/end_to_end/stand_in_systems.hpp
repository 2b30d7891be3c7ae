#pragma once

#include <filesystem>
#include <string>

#include "traverse/files/atomic_file.hpp"

namespace traverse::testing {

/// Small programs that stand for other people's systems: they tell the reference of a simulated
/// recording as their estimate, one pose for each scan, each in its own manner.
inline void write_stand_in_systems(const std::filesystem::path& folder) {
  const auto write = [&](const char* name, const char* text) {
    files::write_text(folder / name, text);
  };
  write("right.sh", R"(awk 'NR % 10 == 1' "${1%.rawlog}.reference.tum" > poses.txt
)");
  write("frame.sh",
        R"(# An antenna 1 m ahead, 2 m to the left and 3 m above the body: p + R (1, 2, 3).
awk 'function turned(i) { return 1 * m[3*i+1] + 2 * m[3*i+2] + 3 * m[3*i+3] }
NR % 10 == 1 { x=$5; y=$6; z=$7; w=$8
  m[1]=1-2*(y*y+z*z); m[2]=2*(x*y-z*w); m[3]=2*(x*z+y*w)
  m[4]=2*(x*y+z*w); m[5]=1-2*(x*x+z*z); m[6]=2*(y*z-x*w)
  m[7]=2*(x*z-y*w); m[8]=2*(y*z+x*w); m[9]=1-2*(x*x+y*y)
  printf "%s %.9f %.9f %.9f %s %s %s %s\n", $1, $2+turned(0), $3+turned(1), $4+turned(2), x, y, z, w
}' "${1%.rawlog}.reference.tum" > antenna.tum
)");
  write("crash.sh", R"(echo 'about to fail'
kill -s SEGV $$
)");
  write("chance.sh", R"(noise=$(od -An -N2 -tu2 /dev/urandom)
awk -v noise="$noise" 'NR % 10 == 1 { $2 += (1 + noise) * 1e-6 * (NR % 20 == 1 ? 1 : -1); print }' \
  "${1%.rawlog}.reference.tum" > poses.txt
)");
  write("kitti.sh", R"(# Twelve numbers a pose, without stamps.
mkdir -p results/latest
awk 'NR == FNR { scans = FNR; next }
FNR % 10 == 1 && (FNR - 1) / 10 < scans { x=$5; y=$6; z=$7; w=$8
  print 1-2*(y*y+z*z), 2*(x*y-z*w), 2*(x*z+y*w), $2, 2*(x*y+z*w), 1-2*(x*x+z*z), 2*(y*z-x*w), $3, \
    2*(x*z-y*w), 2*(y*z+x*w), 1-2*(x*x+y*y), $4
}' "$1/times.txt" "${2%.rawlog}.reference.tum" > results/latest/00_kitti.txt
)");
  write("hang.sh", R"(sleep 600 &
wait
)");
}

/// The plan's pipelines of them.
inline std::string stand_in_pipelines() {
  return R"(pipelines:
  - {name: right, command: "sh {plan}/right.sh {recording}", trajectory: poses.txt, frame: body}
  - name: frame
    command: "sh {plan}/frame.sh {recording}"
    trajectory: "*.tum"
    frame: body
    extrinsic: [1, 2, 3, 0, 0, 0, 1]
  - {name: crash, command: "sh {plan}/crash.sh {recording}", trajectory: poses.txt}
  - {name: chance, command: "sh {plan}/chance.sh {recording}", trajectory: poses.txt, frame: body}
  - name: kitti
    command: "sh {plan}/kitti.sh {format:kitti} {recording}"
    trajectory: results/latest/*.txt
    frame: body
  - {name: hang, command: "sh {plan}/hang.sh", trajectory: poses.txt}
recordings:
  - {simulate: town_short, arguments: {sensor: vlp16, first: 80, duration: 0.6}}
reports: false
)";
}

}  // namespace traverse::testing
