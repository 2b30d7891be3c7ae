// The 3-D view: map, way and reference. Left drag turns, right drag moves, wheel zooms. Drawn only
// when something changes, since a browser without a graphics card takes a tenth of a second.
"use strict";
(() => {
  const stage = document.getElementById("stage");
  const packed = document.getElementById("map-points");
  const probe = document.createElement("canvas");
  const hasWebGl = probe.getContext("webgl2") || probe.getContext("webgl");
  if (!stage || !packed || !hasWebGl || typeof DecompressionStream === "undefined") return;

  const scene = traverse.report.scene;
  const times = traverse.report.poses.time_s;
  const estimate = scene.estimate;
  const control = (id) => document.getElementById(id);

  /** The bytes of packed_points.hpp as arrays. */
  const unpack = async () => {
    const binary = atob(packed.textContent.trim());
    const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const raw = new Uint8Array(await new Response(plain).arrayBuffer());
    const count = scene.points.count;
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

  /** A colour map as numbers; `share` from 0 to 1. */
  const colourMap = (name) => {
    const table = scene.colours[name].map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));
    return (share) => table[Math.round(Math.min(Math.max(share, 0), 1) * (table.length - 1))];
  };
  const viridis = colourMap("viridis");
  const cividis = colourMap("cividis");

  /** Shares of the scale that ends at the 2nd and 98th percentile. */
  const scaled = (values) => {
    const finite = Float64Array.from(values.filter ? values.filter((v) => v !== null) : values).sort();
    const low = finite[Math.floor(0.02 * (finite.length - 1))];
    const high = finite[Math.ceil(0.98 * (finite.length - 1))];
    return { low, high, share: (v) => (high > low ? (v - low) / (high - low) : 0.5) };
  };

  const main = (points) => {
    const count = scene.points.count;
    const [ox, oy, oz] = scene.points.origin_m;
    const step = scene.points.step_m;
    // The scene's origin is the first pose, so that floats are exact enough.
    const centre = estimate.p.slice(0, 3);
    const position = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      position[3 * i] = ox + step * points.x[i] - centre[0];
      position[3 * i + 1] = oy + step * points.y[i] - centre[1];
      position[3 * i + 2] = oz + step * points.z[i] - centre[2];
    }
    const at = (list, i) => new THREE.Vector3(list[3 * i] - centre[0], list[3 * i + 1] - centre[1], list[3 * i + 2] - centre[2]);
    const turn = (i) => new THREE.Quaternion(...estimate.q.slice(4 * i, 4 * i + 4));

    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    stage.append(renderer.domElement);
    const world = new THREE.Scene();
    const camera = new THREE.PerspectiveCamera(50, 1, 0.5, 5000);
    camera.up.set(0, 0, 1);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.enableKeys = false;
    let dirty = true;
    controls.addEventListener("change", () => { dirty = true; });

    // Points.
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    const colour = new THREE.BufferAttribute(new Uint8Array(3 * count), 3, true);
    geometry.setAttribute("color", colour);
    const material = new THREE.PointsMaterial({ size: 2, sizeAttenuation: false, vertexColors: THREE.VertexColors });
    const cloud = new THREE.Points(geometry, material);
    world.add(cloud);

    // The way: a ribbon as wide as a car, flat as the pose has it, and a line for the distance.
    const ribbon = new THREE.BufferGeometry();
    const edge = new Float32Array(6 * traverse.poses);
    const rim = new Float32Array(6 * traverse.poses);
    const line = new Float32Array(3 * traverse.poses);
    const index = [];
    for (let i = 0; i < traverse.poses; ++i) {
      const p = at(estimate.p, i);
      const side = new THREE.Vector3(0, 0.6, 0).applyQuaternion(turn(i));
      const below = p.clone().sub(new THREE.Vector3(0, 0, 0.05));
      below.clone().addScaledVector(side, 1.5).toArray(rim, 6 * i);
      below.clone().addScaledVector(side, -1.5).toArray(rim, 6 * i + 3);
      p.clone().add(side).toArray(edge, 6 * i);
      p.clone().sub(side).toArray(edge, 6 * i + 3);
      p.toArray(line, 3 * i);
      if (i > 0) index.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i - 1, 2 * i + 1, 2 * i);
    }
    ribbon.setAttribute("position", new THREE.BufferAttribute(edge, 3));
    ribbon.setIndex(index);
    const ribbonColour = new THREE.BufferAttribute(new Uint8Array(6 * traverse.poses), 3, true);
    ribbon.setAttribute("color", ribbonColour);
    world.add(new THREE.Mesh(ribbon, new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide })));
    // A rim that lifts it off the map, which may have the same colours.
    const rimGeometry = new THREE.BufferGeometry();
    rimGeometry.setAttribute("position", new THREE.BufferAttribute(rim, 3));
    rimGeometry.setIndex(index);
    const rimMaterial = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
    world.add(new THREE.Mesh(rimGeometry, rimMaterial));
    const thread = new THREE.BufferGeometry();
    thread.setAttribute("position", new THREE.BufferAttribute(line, 3));
    const threadColour = new THREE.BufferAttribute(new Uint8Array(3 * traverse.poses), 3, true);
    thread.setAttribute("color", threadColour);
    world.add(new THREE.Line(thread, new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors })));

    const referenceMaterial = new THREE.LineDashedMaterial({ dashSize: 1.5, gapSize: 1 });
    if (scene.reference) {
      const path = [];
      for (let i = 0; i < scene.reference.p.length / 3; ++i) path.push(at(scene.reference.p, i));
      const reference = new THREE.Line(new THREE.BufferGeometry().setFromPoints(path), referenceMaterial);
      reference.computeLineDistances();
      world.add(reference);
    }

    // Ten-metre grid below the way, and the vehicle.
    const lowest = Math.min(...Array.from({ length: traverse.poses }, (_, i) => line[3 * i + 2])) - 2;
    const extent = 20 * Math.ceil((new THREE.Box3().setFromPoints(Array.from({ length: traverse.poses }, (_, i) => at(estimate.p, i)))
      .getSize(new THREE.Vector3()).length() + 100) / 20);
    const grid = new THREE.GridHelper(2 * extent, extent / 5, 0x808080, 0x808080);
    grid.rotation.x = Math.PI / 2;
    grid.position.z = lowest;
    grid.material.transparent = true;
    grid.material.opacity = 0.25;
    world.add(grid);
    const vehicle = new THREE.Group();
    vehicle.add(new THREE.Mesh(new THREE.BoxBufferGeometry(4, 1.8, 0.5), new THREE.MeshBasicMaterial({ color: 0xcc79a7, transparent: true, opacity: 0.75 })));
    vehicle.add(new THREE.LineSegments(new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(4, 1.8, 0.5)), new THREE.LineBasicMaterial({ color: 0xffffff })));
    vehicle.add(new THREE.AxesHelper(4));
    world.add(vehicle);

    // Colour.
    const errorOf = (pose) => (scene.error_m ? scene.error_m[pose] : null);
    const poseOfPoint = (i) => Math.min(points.pose[i] * scene.points.pose_stride, traverse.poses - 1);
    const paint = (attribute, first, values, map, each) => {
      const scale = scaled(values);
      for (let i = 0; i < values.length; ++i) {
        const rgb = values[i] === null ? [128, 128, 128] : map(scale.share(values[i]));
        for (let k = 0; k < each; ++k) attribute.array.set(rgb, first + 3 * (each * i + k));
      }
      attribute.needsUpdate = true;
      return scale;
    };
    const told = (what, unit, scale) => `${what}: ${traverse.short(scale.low)} to ${traverse.short(scale.high)} ${unit} (2nd to 98th percentile)`;
    const [least, most] = scene.points.intensity;
    const pointValues = {
      height: () => [Array.from({ length: count }, (_, i) => position[3 * i + 2] + centre[2]), viridis, "height", "m"],
      intensity: () => [Array.from(points.intensity, (v) => least + v / 255 * (most - least)), cividis, "intensity", ""],
      time: () => [Array.from({ length: count }, (_, i) => times[poseOfPoint(i)]), viridis, "time of the nearest pose", "s"],
      error: () => [Array.from({ length: count }, (_, i) => errorOf(poseOfPoint(i))), viridis, "error of the nearest pose", "m"],
    };
    const wayValues = {
      error: () => [scene.error_m, viridis, "way: error", "m"],
      time: () => [times, viridis, "way: time", "s"],
      height: () => [Array.from({ length: traverse.poses }, (_, i) => estimate.p[3 * i + 2]), viridis, "way: height", "m"],
    };
    const recolour = () => {
      const [values, map, name, unit] = pointValues[control("colour").value]();
      const scale = paint(colour, 0, values, map, 1);
      const [wayOf, wayMap, wayName, wayUnit] = wayValues[control("way-colour").value]();
      const wayScale = paint(ribbonColour, 0, wayOf, wayMap, 2);
      paint(threadColour, 0, wayOf, wayMap, 1);
      control("scales").textContent = `${told(name, unit, scale)} · ${told(wayName, wayUnit, wayScale)}`;
      stage.dataset.colour = control("colour").value;
      dirty = true;
    };
    const theme = () => {
      world.background = new THREE.Color(traverse.dark.matches ? 0x15171b : 0xffffff);
      rimMaterial.color.set(traverse.dark.matches ? 0xffffff : 0x1c1d21);
      referenceMaterial.color.set(traverse.dark.matches ? 0xdddddd : 0x222222);
      dirty = true;
    };
    if (!scene.error_m) {
      for (const id of ["colour", "way-colour"]) control(id).querySelector("[value=error]").remove();
    }
    if (!(most > least)) control("colour").querySelector("[value=intensity]").remove();

    // Moments.
    const show = (pose, source) => {
      const p = at(estimate.p, pose);
      vehicle.position.copy(p);
      vehicle.quaternion.copy(turn(pose));
      if (source !== "start" && (source !== "slider" || control("follow").checked)) {
        const shift = p.clone().sub(controls.target);
        camera.position.add(shift);
        controls.target.copy(p);
        controls.update();
      }
      control("moment").value = pose;
      control("moment-text").textContent = traverse.describe(pose) +
        (errorOf(pose) !== null ? ` · error ${traverse.short(errorOf(pose))} m` : "");
      stage.dataset.pose = pose;
      dirty = true;
    };
    const lookFrom = (name) => {
      const box = new THREE.Box3().setFromArray(line);
      const size = Math.max(30, box.getSize(new THREE.Vector3()).length());
      box.getCenter(controls.target);
      const direction = name === "above" ? new THREE.Vector3(0, -0.001, 1) : new THREE.Vector3(-0.45, -0.75, 0.6);
      camera.position.copy(controls.target).addScaledVector(direction.normalize(), (name === "above" ? 1.15 : 0.85) * size);
      controls.update();
      dirty = true;
    };

    // Measuring: the two points last clicked.
    const ends = [];
    const rule = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xd55e00, depthTest: false }));
    rule.renderOrder = 1;
    rule.visible = false;
    world.add(rule);
    const measure = (event) => {
      const box = renderer.domElement.getBoundingClientRect();
      const ray = new THREE.Raycaster();
      ray.setFromCamera({ x: 2 * (event.clientX - box.left) / box.width - 1, y: 1 - 2 * (event.clientY - box.top) / box.height }, camera);
      // A few pixels at the distance of the target.
      ray.params.Points.threshold = camera.position.distanceTo(controls.target) * 0.008;
      const hits = ray.intersectObject(cloud).sort((a, b) => a.distanceToRay - b.distanceToRay);
      if (hits.length === 0) return;
      if (ends.length === 2) ends.length = 0;
      const i = hits[0].index;
      ends.push(new THREE.Vector3(position[3 * i], position[3 * i + 1], position[3 * i + 2]));
      if (ends.length === 2) {
        const d = ends[1].clone().sub(ends[0]);
        control("measured").textContent = `${traverse.short(d.length())} m (x ${traverse.short(d.x)}, y ${traverse.short(d.y)}, z ${traverse.short(d.z)} m)`;
        rule.geometry.setFromPoints(ends);
        rule.visible = true;
      } else {
        control("measured").textContent = "click the second point";
        rule.visible = false;
      }
      dirty = true;
    };
    let pressed = null;
    renderer.domElement.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    renderer.domElement.addEventListener("pointerup", (event) => {
      const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
      if (still && control("measure").getAttribute("aria-pressed") === "true") measure(event);
    });

    // Controls.
    control("moment").max = traverse.poses - 1;
    control("moment").addEventListener("input", (event) => traverse.look(Number(event.target.value), "slider"));
    control("colour").addEventListener("change", recolour);
    control("way-colour").addEventListener("change", recolour);
    control("point-size").addEventListener("input", (event) => { material.size = Number(event.target.value); dirty = true; });
    control("from-above").addEventListener("click", () => lookFrom("above"));
    control("oblique").addEventListener("click", () => lookFrom("oblique"));
    control("measure").addEventListener("click", (event) => {
      const on = event.target.getAttribute("aria-pressed") !== "true";
      event.target.setAttribute("aria-pressed", String(on));
      control("measured").textContent = on ? "click two points of the map" : "";
    });
    let playing = null;
    control("play").addEventListener("click", (event) => {
      playing = playing === null ? performance.now() - 1000 * times[traverse.pose] : null;
      event.target.textContent = playing === null ? "Play" : "Stop";
    });

    const resize = () => {
      const width = stage.clientWidth;
      const height = stage.clientHeight;
      if (width === 0 || height === 0) return;
      renderer.setSize(width, height);
      camera.aspect = width / height;
      camera.updateProjectionMatrix();
      dirty = true;
    };
    const frame = () => {
      if (playing !== null) {
        const now = (performance.now() - playing) / 1000;
        let pose = traverse.pose;
        while (pose + 1 < traverse.poses && times[pose + 1] <= now) ++pose;
        if (pose !== traverse.pose) traverse.look(pose, "slider");
        if (pose + 1 >= traverse.poses) control("play").click();
      }
      if (dirty) {
        dirty = false;
        renderer.render(world, camera);
      }
      requestAnimationFrame(frame);
    };

    document.documentElement.classList.add("has-3d");
    control("view-3d").hidden = false;
    if (!scene.error_m) control("way-colour").value = "time";
    theme();
    recolour();
    lookFrom("oblique");
    resize();
    new ResizeObserver(resize).observe(stage);
    traverse.dark.addEventListener("change", theme);
    traverse.follow((pose, source) => show(pose, source));
    show(traverse.pose, "start");
    stage.dataset.points = count;
    // From anywhere on the page: what happens to the camera can be asked for.
    traverse.camera = () => ({ position: camera.position.toArray(), target: controls.target.toArray() });
    frame();
  };

  unpack().then(main);
})();
