#!/usr/bin/env bash
# gl-matrix: the angle between an attitude and itself is NaN for about half of all attitudes and up to 0.05 degrees for
# the others; angles below that cannot be told apart. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages gl-matrix@3.4.4
cat >"$tmp/a.cjs" <<'JS'
const { quat } = require('gl-matrix');
let none = 0;
let worst = 0;
for (let i = 0; i < 1000; ++i) {
  const attitude = quat.fromEuler(quat.create(), i * 0.31, i * 0.17, i * 0.77);
  const angle = quat.getAngle(attitude, attitude);
  if (Number.isNaN(angle)) ++none;
  else worst = Math.max(worst, angle * 180 / Math.PI);
}
const turned = (radians) => quat.setAxisAngle(quat.create(), [0, 0, 1], radians);
const small = quat.getAngle(turned(0.5), turned(0.50001)) * 180 / Math.PI;
console.log(`${none} of 1000 NaN, the others up to ${worst.toFixed(2)} degrees;`,
  `0.0006 degrees apart: ${small.toFixed(3)}`);
JS
report "gl-matrix 3.4.4, quat.getAngle of attitudes with themselves" \
  "0 of 1000 NaN, the others up to 0.00 degrees; 0.0006 degrees apart: 0.001" "$(node "$tmp/a.cjs")" \
  "4.. of 1000 NaN, the others up to 0.05 degrees; 0.0006 degrees apart: 0.01[0-9]"
