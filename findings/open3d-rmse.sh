#!/usr/bin/env bash
# Open3D: a registration in which no point found a partner has the best error there is, an RMSE of 0, so that the failed
# one of two wins whoever compares errors. Needs python3.
source "$(dirname "$0")/install.sh"
debian_with_dependencies python3-open3d=0.16.1+ds-2+b4
seen=$(python3 - <<'PY'
import numpy
import open3d
def cloud(shift):
    points = numpy.random.default_rng(1).uniform(-10, 10, (2000, 3)) + shift
    return open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
for shift in ((0.1, 0, 0), (50, 0, 0)):
    result = open3d.pipelines.registration.evaluate_registration(cloud((0, 0, 0)), cloud(shift), 1.0)
    print("%g m off: RMSE %.2f m" % (shift[0], result.inlier_rmse), end="; ")
PY
)
report "Open3D 0.16.1, evaluate_registration" "0.1 m off: RMSE 0.10 m; 50 m off: RMSE infinite or undefined; " "$seen" \
  "0.1 m off: RMSE 0.10 m; 50 m off: RMSE 0.00 m; "
