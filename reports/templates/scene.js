// The 3-D view: map, way and reference. Left drag turns, right drag moves, wheel zooms. Drawn only
// when something changes, since a browser without a graphics card takes a tenth of a second.
"use strict";
(() => {
  const stage = document.getElementById("stage");
  const probe = document.createElement("canvas");
  const hasWebGl = probe.getContext("webgl2") || probe.getContext("webgl");
  if (!stage || !document.getElementById("map-points") || !hasWebGl || typeof DecompressionStream === "undefined") return;

  const scene = traverse.report.scene;
  const times = traverse.report.poses.time_s;
  const control = (id) => document.getElementById(id);
  let dirty = true;
  const changed = () => { dirty = true; };

  const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(50, 1, 0.5, 5000);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.enableKeys = false;
  controls.addEventListener("change", changed);

  const lookFrom = (name, line) => {
    const box = new THREE.Box3().setFromArray(line);
    const size = Math.max(30, box.getSize(new THREE.Vector3()).length());
    box.getCenter(controls.target);
    const direction = name === "above" ? new THREE.Vector3(0, -0.001, 1) : new THREE.Vector3(-0.45, -0.75, 0.6);
    camera.position.copy(controls.target).addScaledVector(direction.normalize(), (name === "above" ? 1.15 : 0.85) * size);
    controls.update();
    changed();
  };

  /** Offers what there are values for, and paints what is chosen. */
  const setUpColours = (points, way) => {
    for (const [id, values] of [["colour", points.values], ["way-colour", way.values]]) {
      for (const option of [...control(id).options]) if (!(option.value in values)) option.remove();
    }
    const recolour = () => {
      const [values, map, name, unit] = points.values[control("colour").value]();
      const scale = sceneColours.paint(points.colour, values, map, 1);
      const [wayOf, wayMap, wayName, wayUnit] = way.values[control("way-colour").value]();
      const wayScale = way.paint(wayOf, wayMap);
      control("scales").textContent = `${sceneColours.told(name, unit, scale)} · ${sceneColours.told(wayName, wayUnit, wayScale)}`;
      stage.dataset.colour = control("colour").value;
      changed();
    };
    control("colour").addEventListener("change", recolour);
    control("way-colour").addEventListener("change", recolour);
    recolour();
  };

  const setUpTheme = (rim, reference) => {
    const theme = () => {
      world.background = new THREE.Color(traverse.dark.matches ? 0x15171b : 0xffffff);
      rim.color.set(traverse.dark.matches ? 0xffffff : 0x1c1d21);
      reference.color.set(traverse.dark.matches ? 0xdddddd : 0x222222);
      changed();
    };
    traverse.dark.addEventListener("change", theme);
    theme();
  };

  /** The vehicle stands where the page looks; the camera goes with it. */
  const setUpMoments = (vehicle) => {
    const show = (pose, source) => {
      const p = sceneWay.positionOf(pose);
      vehicle.position.copy(p);
      vehicle.quaternion.copy(sceneWay.turnOf(pose));
      if (source !== "start" && (source !== "slider" || control("follow").checked)) {
        const shift = p.clone().sub(controls.target);
        camera.position.add(shift);
        controls.target.copy(p);
        controls.update();
      }
      control("moment").value = pose;
      const error = scene.error_m ? scene.error_m[pose] : null;
      control("moment-text").textContent = traverse.describe(pose) +
        (error !== null ? ` · error ${traverse.figure(error)} m` : "");
      stage.dataset.pose = pose;
      changed();
    };
    control("moment").max = traverse.poses - 1;
    control("moment").addEventListener("input", (event) => traverse.look(Number(event.target.value), "slider"));
    traverse.follow(show);
    show(traverse.pose, "start");
  };

  /** \returns what moves the vehicle on while it plays, once a picture. */
  const setUpPlaying = () => {
    let begun = null;
    control("play").addEventListener("click", (event) => {
      begun = begun === null ? performance.now() - 1000 * times[traverse.pose] : null;
      event.target.textContent = begun === null ? "Play" : "Stop";
    });
    return () => {
      if (begun === null) return;
      const now = (performance.now() - begun) / 1000;
      let pose = traverse.pose;
      while (pose + 1 < traverse.poses && times[pose + 1] <= now) ++pose;
      if (pose !== traverse.pose) traverse.look(pose, "slider");
      if (pose + 1 >= traverse.poses) control("play").click();
    };
  };

  const resize = () => {
    const width = stage.clientWidth;
    const height = stage.clientHeight;
    if (width === 0 || height === 0) return;
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    changed();
  };

  const main = (unpacked) => {
    const points = scenePoints.build(unpacked, sceneWay.centre);
    world.add(points.cloud);
    const way = sceneWay.buildWay(world);
    const reference = sceneWay.buildReference(world);
    sceneWay.buildGrid(world, way.line);
    const vehicle = sceneWay.buildVehicle(world);

    stage.append(renderer.domElement);
    document.documentElement.classList.add("has-3d");
    control("view-3d").hidden = false;
    setUpTheme(way.rimMaterial, reference);
    setUpColours(points, way);
    lookFrom("oblique", way.line);
    resize();
    new ResizeObserver(resize).observe(stage);
    setUpMoments(vehicle);
    sceneMeasure.build(world, renderer.domElement, camera, controls.target, points.cloud, changed);
    control("point-size").addEventListener("input", (event) => { points.material.size = Number(event.target.value); changed(); });
    control("from-above").addEventListener("click", () => lookFrom("above", way.line));
    control("oblique").addEventListener("click", () => lookFrom("oblique", way.line));
    const playOn = setUpPlaying();
    stage.dataset.points = scene.points.count;
    // From anywhere on the page: what happens to the camera can be asked for.
    traverse.camera = () => ({ position: camera.position.toArray(), target: controls.target.toArray() });

    const frame = () => {
      playOn();
      if (dirty) {
        dirty = false;
        renderer.render(world, camera);
      }
      requestAnimationFrame(frame);
    };
    frame();
  };

  scenePoints.unpack().then(main);
})();
