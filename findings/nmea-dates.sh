#!/usr/bin/env bash
# npm's gps and nmea-simple: a GGA has no date, and both give it today's (of the machine that reads): one epoch of a log
# of 2024 gets its right time from RMC and a time years later from GGA. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages gps@0.9.0 nmea-simple@3.3.0
cat >"$tmp/a.cjs" <<'JS'
const gps = require('gps');
const nmea = require('nmea-simple');
const sentence = (body) => {
  const sum = [...body].reduce((a, c) => a ^ c.charCodeAt(0), 0);
  return `$${body}*${sum.toString(16).toUpperCase().padStart(2, '0')}`;
};
const rmc = sentence('GPRMC,120000.00,A,4807.40000,N,01107.40000,E,10.0,90.0,010324,,,A');
const gga = sentence('GPGGA,120000.00,4807.40000,N,01107.40000,E,4,12,0.5,512.3,M,46.9,M,1.0,0001');
const day = (date) => {
  const text = date ? date.toISOString().slice(0, 10) : 'none';
  return text === new Date().toISOString().slice(0, 10) ? 'today' : text;
};
console.log(`gps: RMC ${day(gps.Parse(rmc).time)}, GGA ${day(gps.Parse(gga).time)};`,
  `nmea-simple: RMC ${day(nmea.parseNmeaSentence(rmc).datetime)}, GGA ${day(nmea.parseNmeaSentence(gga).time)}`);
JS
report "gps 0.9.0, nmea-simple 3.3.0, one epoch of 2024-03-01" \
  "gps: RMC 2024-03-01, GGA none; nmea-simple: RMC 2024-03-01, GGA none" "$(node "$tmp/a.cjs")" \
  "gps: RMC 2024-03-01, GGA today; nmea-simple: RMC 2024-03-01, GGA today"
