#!/usr/bin/env bash
# @tmcw/togeojson: a track point without a time (GPX allows it) leaves no gap in the list of times, so that each later
# point is paired with the time of the one after it. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @tmcw/togeojson@7.1.3 @xmldom/xmldom@0.9.8
cat >"$tmp/a.mjs" <<'JS'
import { gpx } from '@tmcw/togeojson';
import { DOMParser } from '@xmldom/xmldom';
const points = [0, 1, 2, 3].map((second) => `<trkpt lat="48.${second}" lon="11">` +
  (second === 1 ? '' : `<time>2026-03-01T12:00:0${second}Z</time>`) + '</trkpt>').join('');
const text = '<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>' +
  `${points}</trkseg></trk></gpx>`;
const { geometry, properties } = gpx(new DOMParser().parseFromString(text, 'text/xml')).features[0];
console.log(geometry.coordinates.map(([, latitude], i) =>
  `${latitude}@${properties.coordinateProperties.times[i]?.slice(-3, -1) ?? 'none'}`).join(' '));
JS
report "@tmcw/togeojson 7.1.3, latitude @ second" "48@00 48.1@none 48.2@02 48.3@03" "$(node "$tmp/a.mjs")" \
  "48@00 48.1@02 48.2@03 48.3@none"
