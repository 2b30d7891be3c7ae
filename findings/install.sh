# Sourced by the findings. Pinned packages go into a temporary folder that is removed at exit; nothing on the machine
# changes and no root is needed. Needs apt-get, and what a finding names beside it: g++, python3 or node with npm.
set -euo pipefail
tmp=$(mktemp -d)
chmod 755 "$tmp"
trap 'rm -rf "$tmp"' EXIT
root=$tmp/root
lib=$root/usr/lib/$(uname -m)-linux-gnu
apt=(-q -o Debug::NoLocking=1 -o Dir::Cache="$tmp/apt" -o APT::Install-Recommends=0)
mkdir -p "$root" "$tmp/deb" "$tmp/apt/archives/partial" "$tmp/lists/partial"
if [ -z "$(apt-cache madison bash 2>/dev/null)" ]; then # no package lists here: fetch private ones
  apt+=(-o Dir::State::lists="$tmp/lists")
  apt-get "${apt[@]}" update >/dev/null
fi

# debian NAME=VERSION...: these packages alone.
debian() {
  (cd "$tmp/deb" && apt-get "${apt[@]}" download "$@" >/dev/null 2>&1) || { echo "cannot get: $*" >&2; exit 3; }
  local deb
  for deb in "$tmp"/deb/*.deb; do dpkg-deb -x "$deb" "$root"; rm "$deb"; done
}

# debian_with_dependencies NAME=VERSION...: also what they need and the machine has not.
debian_with_dependencies() {
  local plan
  plan=$(apt-get "${apt[@]}" -s install "$@") || { echo "cannot plan: $*" >&2; exit 3; }
  debian "$@" $(awk '/^Inst/ { match($0, /\([^ ]+/); print $2 "=" substr($0, RSTART + 1, RLENGTH - 1) }' <<<"$plan")
}

# npm_packages NAME@VERSION...: into $tmp, where node then finds them.
npm_packages() { npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$tmp" "$@" >/dev/null; }

# cxx FLAG...: the program on standard input, built as $tmp/probe.
cxx() { cat >"$tmp/probe.cpp" && g++ -std=c++17 -O1 -w "$tmp/probe.cpp" -o "$tmp/probe" "$@"; }

# report VERSION EXPECTED SEEN PATTERN: prints the first three; fails unless PATTERN matches the whole of SEEN.
report() {
  printf 'version:  %s\nexpected: %s\nseen:     %s\n' "$1" "$2" "$3"
  [[ $3 =~ ^($4)$ ]] || { echo 'not as described: this has changed' >&2; exit 1; }
}

export CPLUS_INCLUDE_PATH=$root/usr/include:$root/usr/include/eigen3:$root/usr/include/$(uname -m)-linux-gnu
export LIBRARY_PATH=$lib LD_LIBRARY_PATH=$lib:$lib/blas:$lib/lapack:$root/usr/lib:$root/lib/$(uname -m)-linux-gnu
export PYTHONPATH=$root/usr/lib/python3/dist-packages PATH=$root/usr/bin:/usr/bin:$PATH
