#!/usr/bin/env bash
# GPSBabel: of an NMEA log in which RMC comes before GGA (the order of many receivers), each position gets the time of
# the next epoch; the first position comes twice and the last is lost. With GGA first, the track is right.
source "$(dirname "$0")/install.sh"
debian_with_dependencies gpsbabel=1.8.0+ds-5
sentence() { # the words with their checksum
  local sum=0 i
  for ((i = 0; i < ${#1}; ++i)); do sum=$((sum ^ $(printf %d "'${1:i:1}"))); done
  printf '$%s*%02X\r\n' "$1" "$sum"
}
track() { # latitudes in minutes and seconds of four epochs, as GPSBabel reads them
  local k sentences
  for k in 0 1 2 3; do
    local rmc="GNRMC,12000$k.00,A,4800.${k}0000,N,01100.00000,E,10.0,90.0,010326,,,A"
    local gga="GNGGA,12000$k.00,4800.${k}0000,N,01100.00000,E,4,12,0.5,50$k.0,M,46.9,M,1.0,0001"
    if [ "$1" = rmc ]; then sentences=("$rmc" "$gga"); else sentences=("$gga" "$rmc"); fi
    sentence "${sentences[0]}"
    sentence "${sentences[1]}"
  done >"$tmp/log.nmea"
  gpsbabel -t -i nmea -f "$tmp/log.nmea" -o unicsv -F - | tr -d '\r' | awk -F, '
    NR > 1 { printf " %.1f@%s", ($2 - 48) * 60, substr($NF, 7, 2) }'
}
report "GPSBabel 1.8.0, minute of latitude @ second" \
  "GGA first 0.0@00 0.1@01 0.2@02 0.3@03; RMC first 0.0@00 0.1@01 0.2@02 0.3@03" \
  "GGA first$(track gga); RMC first$(track rmc)" \
  "GGA first 0.0@00 0.1@01 0.2@02 0.3@03; RMC first 0.0@00 0.0@01 0.1@02 0.2@03"
