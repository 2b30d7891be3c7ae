// The points of the map in the 3-D view.
"use strict";
const scenePoints = (() => {
  const facts = traverse.report.scene.points;

  /** The bytes of packed_points.hpp as arrays. */
  const unpack = async () => {
    const binary = atob(document.getElementById("map-points").textContent.trim());
    const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const raw = new Uint8Array(await new Response(plain).arrayBuffer());
    const count = facts.count;
    const field = (number) => {
      const low = 2 * number * count;
      const values = new Uint16Array(count);
      let value = 0;
      for (let i = 0; i < count; ++i) {
        value = (value + raw[low + i] + 256 * raw[low + count + i]) & 0xffff;
        values[i] = value;
      }
      return values;
    };
    return { x: field(0), y: field(1), z: field(2), pose: field(3), intensity: raw.subarray(8 * count, 9 * count) };
  };

  /** The cloud about `centre`, and what its points can be coloured by. */
  const build = (points, centre) => {
    const count = facts.count;
    const [ox, oy, oz] = facts.origin_m;
    const step = facts.step_m;
    const position = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      position[3 * i] = ox + step * points.x[i] - centre[0];
      position[3 * i + 1] = oy + step * points.y[i] - centre[1];
      position[3 * i + 2] = oz + step * points.z[i] - centre[2];
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    const colour = new THREE.BufferAttribute(new Uint8Array(3 * count), 3, true);
    geometry.setAttribute("color", colour);
    const material = new THREE.PointsMaterial({ size: 2, sizeAttenuation: false, vertexColors: THREE.VertexColors });
    const cloud = new THREE.Points(geometry, material);

    const { viridis, cividis } = sceneColours;
    const { error_m: error } = traverse.report.scene;
    const times = traverse.report.poses.time_s;
    const [least, most] = facts.intensity;
    const poseOf = (i) => Math.min(points.pose[i] * facts.pose_stride, traverse.poses - 1);
    const each = (value) => Array.from({ length: count }, (_, i) => value(i));
    const values = {
      height: () => [each((i) => position[3 * i + 2] + centre[2]), viridis, "height", "m"],
      intensity: () => [each((i) => least + points.intensity[i] / 255 * (most - least)), cividis, "intensity", ""],
      time: () => [each((i) => times[poseOf(i)]), viridis, "time of the nearest pose", "s"],
      error: () => [each((i) => error[poseOf(i)]), viridis, "error of the nearest pose", "m"],
    };
    if (!error) delete values.error;
    if (!(most > least)) delete values.intensity;
    return { cloud, colour, material, values };
  };

  return { unpack, build };
})();
