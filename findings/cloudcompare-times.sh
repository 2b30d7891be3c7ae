#!/usr/bin/env bash
# CloudCompare on the command line: times of points do not come through. As a column of a text file they are kept in 32
# bits, so stamps of this epoch, 0.1 s apart, become one; as a property of a PLY they are left out. Neither is said, and
# coordinates as large come through with -GLOBAL_SHIFT AUTO.
source "$(dirname "$0")/install.sh"
debian_with_dependencies cloudcompare=2.11.3-7.1
export LD_LIBRARY_PATH=$LD_LIBRARY_PATH:$lib/cloudcompare QT_QPA_PLATFORM=offscreen HOME=$tmp
cd "$tmp"
points='500000.3 5330438.3 512.3 1700000000.25
500001.3 5330439.3 512.3 1700000000.35'
echo "$points" >text.xyz
{
  printf 'ply\nformat ascii 1.0\nelement vertex 2\n'
  printf 'property double %s\n' x y z time
  printf 'end_header\n%s\n' "$points"
} >cloud.ply
# through FILE: what the first point is afterwards, and whether the second has the same time.
through() {
  CloudCompare -SILENT -AUTO_SAVE OFF -C_EXPORT_FMT ASC -PREC 2 -O -GLOBAL_SHIFT AUTO "$1" -SAVE_CLOUDS FILE out.asc \
    >log.txt 2>&1 || cat log.txt
  awk 'NR == 1 { first = $0; time = $4 } NR == 2 { print first (NF < 4 ? ", no time" : $4 == time ? ", same time" : ", later") }' out.asc
  rm out.asc
}
report "CloudCompare 2.11.3, 500000.3 5330438.3 512.3 at 1700000000.25 s and a point 0.1 s later" \
  "text and PLY: 500000.30 5330438.30 512.30 1700000000.25, later" "text: $(through text.xyz); PLY: $(through cloud.ply)" \
  "text: 500000.30 5330438.30 512.30 1700000000.00, same time; PLY: 500000.30 5330438.30 512.30, no time"
