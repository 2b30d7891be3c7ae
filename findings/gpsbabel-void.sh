#!/usr/bin/env bash
# GPSBabel: a GPX track written as NMEA is marked void (status V, quality 0), since GPX tracks seldom name a kind of
# fix, so its own reader gives an empty track back; and 3 decimals of a minute move the points by up to 0.9 m.
source "$(dirname "$0")/install.sh"
debian_with_dependencies gpsbabel=1.8.0+ds-5
{
  echo '<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>'
  for k in 1 2 3; do
    echo "<trkpt lat=\"48.12345$k\" lon=\"11.12345$k\"><ele>512</ele><time>2026-03-01T12:00:0${k}Z</time></trkpt>"
  done
  echo '</trkseg></trk></gpx>'
} >"$tmp/track.gpx"
gpsbabel -i gpx -f "$tmp/track.gpx" -o nmea -F "$tmp/track.nmea"
gpsbabel -i nmea -f "$tmp/track.nmea" -o gpx -F "$tmp/back.gpx"
latitudes=$(awk -F, '/RMC/ { print $4 }' "$tmp/track.nmea" | sort -u | paste -sd ' ')
points=$(grep -c '<trkpt' "$tmp/back.gpx" || true)
report "GPSBabel 1.8.0, three points at 48.123451, 48.123452 and 48.123453" \
  "latitudes 4807.40706 4807.40712 4807.40718; 3 points come back" "latitudes $latitudes; $points points come back" \
  "latitudes 4807.407; 0 points come back"
