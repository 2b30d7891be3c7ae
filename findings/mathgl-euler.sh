#!/usr/bin/env bash
# @math.gl/core (deck.gl and loaders.gl calculate with it): the quaternion of Euler angles from getQuaternion() has roll
# and yaw changed over; toQuaternion() and the matrix of the same angles are right. Needs node and npm.
source "$(dirname "$0")/install.sh"
npm_packages @math.gl/core@4.1.0
cat >"$tmp/a.cjs" <<'JS'
const { Euler, Matrix4 } = require('@math.gl/core');
const text = (angles) => [...angles].slice(0, 3).map((angle) => angle.toFixed(1)).join(' ');
const angles = new Euler().fromRollPitchYaw(0.1, 0.2, 0.5);
const matrix = new Euler().fromRotationMatrix(angles.getRotationMatrix(new Matrix4()));
console.log(`${text(matrix)} by getRotationMatrix, ${text(new Euler().fromQuaternion(angles.toQuaternion()))} by`,
  `toQuaternion, ${text(new Euler().fromQuaternion(angles.getQuaternion()))} by getQuaternion`);
JS
report "@math.gl/core 4.1.0, roll 0.1, pitch 0.2, yaw 0.5, there and back" \
  "0.1 0.2 0.5 by getRotationMatrix, 0.1 0.2 0.5 by toQuaternion, 0.1 0.2 0.5 by getQuaternion" \
  "$(node "$tmp/a.cjs")" \
  "0.1 0.2 0.5 by getRotationMatrix, 0.1 0.2 0.5 by toQuaternion, 0.5 0.2 0.1 by getQuaternion"
