// Measuring in the 3-D view: the distance of the two points of the map last clicked.
"use strict";
const sceneMeasure = (() => {
  /** \param target what the camera turns about  \param changed called when there is something to draw */
  const build = (world, canvas, camera, target, cloud, changed) => {
    const mode = document.getElementById("measure");
    const told = document.getElementById("measured");
    const position = cloud.geometry.getAttribute("position");
    const ends = [];
    const rule = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0xd55e00, depthTest: false }));
    rule.renderOrder = 1;
    rule.visible = false;
    world.add(rule);

    const pointUnder = (event) => {
      const box = canvas.getBoundingClientRect();
      const ray = new THREE.Raycaster();
      ray.setFromCamera({ x: 2 * (event.clientX - box.left) / box.width - 1, y: 1 - 2 * (event.clientY - box.top) / box.height }, camera);
      // A few pixels at the distance of the target.
      ray.params.Points.threshold = camera.position.distanceTo(target) * 0.008;
      const hits = ray.intersectObject(cloud).sort((a, b) => a.distanceToRay - b.distanceToRay);
      return hits.length === 0 ? null : new THREE.Vector3().fromBufferAttribute(position, hits[0].index);
    };
    const take = (point) => {
      if (ends.length === 2) ends.length = 0;
      ends.push(point);
      rule.visible = ends.length === 2;
      if (rule.visible) {
        const d = ends[1].clone().sub(ends[0]);
        told.textContent = `${traverse.figure(d.length())} m (x ${traverse.figure(d.x)}, y ${traverse.figure(d.y)}, z ${traverse.figure(d.z)} m)`;
        rule.geometry.setFromPoints(ends);
      } else {
        told.textContent = "click the second point";
      }
      changed();
    };

    const isOn = () => mode.getAttribute("aria-pressed") === "true";
    mode.addEventListener("click", () => {
      mode.setAttribute("aria-pressed", String(!isOn()));
      told.textContent = isOn() ? "click two points of the map" : "";
      rule.visible = false;
      ends.length = 0;
      changed();
    });
    let pressed = null;
    canvas.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    canvas.addEventListener("pointerup", (event) => {
      // A drag turns the view.
      const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
      const point = still && isOn() ? pointUnder(event) : null;
      if (point) take(point);
    });
  };

  return { build };
})();
