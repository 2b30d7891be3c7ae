// The way, the reference, the ground grid and the vehicle in the 3-D view.
"use strict";
const sceneWay = (() => {
  const estimate = traverse.report.scene.estimate;
  // The scene's origin is the first pose, so that floats are exact enough.
  const centre = estimate.p.slice(0, 3);
  const at = (list, i) => new THREE.Vector3(list[3 * i] - centre[0], list[3 * i + 1] - centre[1], list[3 * i + 2] - centre[2]);
  const positionOf = (pose) => at(estimate.p, pose);
  const turnOf = (pose) => new THREE.Quaternion(...estimate.q.slice(4 * pose, 4 * pose + 4));

  const coloured = (geometry, vertices) => {
    const colour = new THREE.BufferAttribute(new Uint8Array(3 * vertices), 3, true);
    geometry.setAttribute("color", colour);
    return colour;
  };

  /** A ribbon as wide as a car, flat as the pose has it, with a rim that lifts it off the map, which
   *  may have the same colours, and a line to be seen from far. */
  const buildWay = (world) => {
    const edge = new Float32Array(6 * traverse.poses);
    const rim = new Float32Array(6 * traverse.poses);
    const line = new Float32Array(3 * traverse.poses);
    const index = [];
    for (let i = 0; i < traverse.poses; ++i) {
      const p = positionOf(i);
      const side = new THREE.Vector3(0, 0.6, 0).applyQuaternion(turnOf(i));
      const below = p.clone().sub(new THREE.Vector3(0, 0, 0.05));
      below.clone().addScaledVector(side, 1.5).toArray(rim, 6 * i);
      below.clone().addScaledVector(side, -1.5).toArray(rim, 6 * i + 3);
      p.clone().add(side).toArray(edge, 6 * i);
      p.clone().sub(side).toArray(edge, 6 * i + 3);
      p.toArray(line, 3 * i);
      if (i > 0) index.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i - 1, 2 * i + 1, 2 * i);
    }
    const strip = (vertices) => {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
      geometry.setIndex(index);
      return geometry;
    };
    const ribbon = strip(edge);
    const ribbonColour = coloured(ribbon, 2 * traverse.poses);
    world.add(new THREE.Mesh(ribbon, new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide })));
    const rimMaterial = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
    world.add(new THREE.Mesh(strip(rim), rimMaterial));
    const thread = new THREE.BufferGeometry();
    thread.setAttribute("position", new THREE.BufferAttribute(line, 3));
    const threadColour = coloured(thread, traverse.poses);
    world.add(new THREE.Line(thread, new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors })));

    const { viridis, paint } = sceneColours;
    const error = traverse.report.scene.error_m;
    const values = {
      error: () => [error, viridis, "trajectory: error", "m"],
      time: () => [traverse.report.poses.time_s, viridis, "trajectory: time", "s"],
      height: () => [Array.from({ length: traverse.poses }, (_, i) => estimate.p[3 * i + 2]), viridis, "trajectory: height", "m"],
    };
    if (!error) delete values.error;
    return {
      line, rimMaterial, values,
      paint: (numbers, map) => {
        paint(threadColour, numbers, map, 1);
        return paint(ribbonColour, numbers, map, 2);
      },
    };
  };

  /** \returns the material of the dashed line, whose colour follows the theme. */
  const buildReference = (world) => {
    const material = new THREE.LineDashedMaterial({ dashSize: 1.5, gapSize: 1 });
    const reference = traverse.report.scene.reference;
    if (!reference) return material;
    const path = Array.from({ length: reference.p.length / 3 }, (_, i) => at(reference.p, i));
    const line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(path), material);
    line.computeLineDistances();
    world.add(line);
    return material;
  };

  /** Ten-metre cells two metres below the lowest pose. */
  const buildGrid = (world, line) => {
    const box = new THREE.Box3().setFromArray(line);
    const extent = 20 * Math.ceil((box.getSize(new THREE.Vector3()).length() + 100) / 20);
    const grid = new THREE.GridHelper(2 * extent, extent / 5, 0x808080, 0x808080);
    grid.rotation.x = Math.PI / 2;
    grid.position.z = box.min.z - 2;
    grid.material.transparent = true;
    grid.material.opacity = 0.25;
    world.add(grid);
  };

  const buildVehicle = (world) => {
    const vehicle = new THREE.Group();
    const body = new THREE.BoxBufferGeometry(4, 1.8, 0.5);
    vehicle.add(new THREE.Mesh(body, new THREE.MeshBasicMaterial({ color: 0xcc79a7, transparent: true, opacity: 0.75 })));
    vehicle.add(new THREE.LineSegments(new THREE.EdgesGeometry(body), new THREE.LineBasicMaterial({ color: 0xffffff })));
    vehicle.add(new THREE.AxesHelper(4));
    world.add(vehicle);
    return vehicle;
  };

  return { centre, positionOf, turnOf, buildWay, buildReference, buildGrid, buildVehicle };
})();
