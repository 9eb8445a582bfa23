// Draws the 3D replay of the run at the current time of the page, with three.js.
// 1. The function makeReplay builds the scene once: scenery, one vehicle for each track, trails and
//    plans.
// 2. In each rendered frame, the vehicles are moved to their poses, which are interpolated between
//    the rows of the log.
// 3. A camera follows a car, orbits it or sits on the driver's seat. Several cars are shown
//    together, or apart in one view each.

// maximum number of ghosts (translucent cars of other plants) whose names are shown
const MOST_NAMED = 4;
const CAMERAS = [['follow', 'Follow'], ['orbit', 'Orbit'], ['driver', 'Driver']];

/** Returns the color of a track for WebGL. */
function solidColor(track) {
  return cssColor(`--scene-${track.color}`) || '#888888';
}

/** Makes the path that a car has driven so far, as a growing strip on the ground. */
function trailOf(track, motion, height, width, level) {
  const { t, channels: { x_m: xs, y_m: ys } } = motion;
  let rows = [];
  const geometry = () => {
    const step = Math.max(1, Math.floor(t.length / 2500));
    rows = d3.range(0, t.length, step);
    const points = rows.map((row, i) => {
      const [a, b] = [rows[Math.max(0, i - 1)], rows[Math.min(rows.length - 1, i + 1)]];
      const heading = Math.atan2(ys[b] - ys[a], xs[b] - xs[a]);
      return { x: xs[row], y: ys[row], nx: -Math.sin(heading), ny: Math.cos(heading) };
    });
    return strip(points, -width / 2, width / 2, height, 0.018);
  };
  const mesh = flat(geometry(), solidColor(track), level);
  mesh.material.emissive = new THREE.Color(solidColor(track));
  mesh.material.emissiveIntensity = 0.35;
  return {
    mesh,
    grow: () => {
      mesh.geometry.dispose();
      mesh.geometry = geometry();
    },
    update: (time) => {
      const count = d3.bisectRight(rows.map((row) => t[row]), time) - 1;
      mesh.geometry.setDrawRange(0, Math.max(0, 6 * count));
    },
  };
}

/** Makes a dashed line along a plan. */
function planMesh(line, height, color, level) {
  const points = evenly(line, 0.5);
  if (points.length < 3) return null;
  return flat(strip(points, -0.06, 0.06, height, 0.016, (i) => i % 3 !== 0), color, level,
    { emissive: new THREE.Color(color), emissiveIntensity: 0.4 });
}

function makeReplay(canvas, context) {
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  // Checking a shader for errors would wait until the shader is compiled. Without checks for
  // errors, the graphics driver compiles several shaders at the same time.
  renderer.debug.checkShaderErrors = false;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  renderer.autoClear = false;
  const pixelRatio = Math.min(2, window.devicePixelRatio || 1);
  renderer.setPixelRatio(pixelRatio);

  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xbdd3e6);
  scene.fog = new THREE.Fog(0xbdd3e6, 120, 700);
  scene.add(new THREE.HemisphereLight(0xf2f6ff, 0xb4b49c, 0.7));
  const sun = new THREE.DirectionalLight(0xfff4e0, 0.46);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  Object.assign(sun.shadow.camera, { left: -32, right: 32, top: 32, bottom: -32, near: 1, far: 120 });
  sun.shadow.bias = -0.0006;
  scene.add(sun, sun.target);

  const height = heightOf(runs[0].ground);
  const makers = runs.map((run) => vehicleMaker(run.vehicle));
  const scenery = drawScenery(scene, height, makers);
  const cars = tracks.map((track) => {
    const motion = motionOf(track);
    const make = makers[track.run];
    return {
      track, motion,
      solid: make({ color: solidColor(track), ghost: false }),
      ghost: make({ color: solidColor(track), ghost: true }),
      use: tyreUse(track),
      wind: windAt(track),
      // The trails of several cars may overlap, so the trails of later tracks are narrower and
      // drawn on top.
      trail: trailOf(track, motion, height, 0.34 / (1 + track.id), 6 + track.id),
    };
  });
  for (const car of cars) {
    scene.add(car.solid.group, car.ghost.group, car.trail.mesh);
    car.skid = makeSkidMarks(car.track, car.solid, car.motion, runs[car.track.run].vehicle, height);
    if (car.skid) scene.add(car.skid.mesh);
  }
  const dials = cars.some(({ use }) => use) ? makeDials(scene) : null;
  const wind = cars.some((car) => car.wind) ? makeWind(scene, height) : null;

  const plans = [];
  const seen = new Set();
  for (const run of runs) {
    const line = run.plan && run.plan.line;
    if (line && !seen.has(JSON.stringify(line))) {
      seen.add(JSON.stringify(line));
      const mesh = planMesh(line, height, 0xf7d94c, 4);
      if (mesh) { scene.add(mesh); plans.push({ mesh, shown: () => true }); }
    }
  }
  const drawnPlans = new Set();
  function drawNewPlans() {
    for (const { track } of cars) {
      track.newPlans.forEach((plan, i) => {
        if (drawnPlans.has(plan)) return;
        drawnPlans.add(plan);
        const mesh = planMesh(plan, height, solidColor(track), 5);
        const until = () => (i + 1 < track.newPlans.length ? track.newPlans[i + 1].from : Infinity);
        if (mesh) { scene.add(mesh); plans.push({ mesh, shown: (time) => track.visible && time >= plan.from && time < until() }); }
      });
    }
  }
  drawNewPlans();
  bus.on('rows.replay', () => {
    for (const { trail } of cars) trail.grow();
    drawNewPlans();
  });

  // The car that is shown first: preferably that of a MuJoCo plant.
  const lead = cars.find(({ track }) => track.plant.startsWith('mujoco')) || cars[cars.length - 1];

  /**
   * Returns the pose of a car, and its heading averaged over one second, which steadies the camera.
   */
  function framing(car, time) {
    const moments = [-0.5, -0.25, 0, 0.25, 0.5].map((dt) => poseAt(car.track, Math.min(Math.max(time + dt, 0), duration)));
    const x = d3.mean(moments, (pose) => Math.cos(pose.yaw));
    const y = d3.mean(moments, (pose) => Math.sin(pose.yaw));
    const speed = valueAt(car.track, 'speed', Math.min(time, car.track.log.t[car.track.log.t.length - 1])) || 0;
    return { pose: poseAt(car.track, time), heading: Math.atan2(y, x), backwards: speed < -0.2 };
  }

  function cameraFor(kind, car, time, aspect, orbit) {
    const { pose, heading, backwards } = framing(car, time);
    const camera = new THREE.PerspectiveCamera(kind === 'driver' ? 66 : 46, aspect, 0.1, 1500);
    camera.up.set(0, 0, 1);
    const z = height(pose.x, pose.y);
    const { length, rear_overhang: overhang, trailer } = runs[car.track.run].car;
    const middle = length / 2 - overhang;
    // length of the car's hitch and trailer behind the car
    const towed = trailer ? trailer.hitch - overhang + trailer.tongue - trailer.body_ahead + trailer.length / 2 : 0;
    const ahead = (along, across, up) => new THREE.Vector3(
      pose.x + along * Math.cos(heading) - across * Math.sin(heading),
      pose.y + along * Math.sin(heading) + across * Math.cos(heading), z + up);
    if (kind === 'driver') {
      car.solid.root.updateMatrixWorld(true);
      const eye = new THREE.Vector3(middle, 0.1 * length, 0.29 * length).applyMatrix4(car.solid.root.matrix);
      camera.position.copy(eye);
      const look = new THREE.Vector3(middle + 20, 0.05 * length, 0).applyMatrix4(car.solid.root.matrix);
      camera.lookAt(look);
    } else if (kind === 'orbit') {
      camera.position.copy(ahead(middle, 0, 0.6)).add(orbit);
      camera.lookAt(ahead(middle, 0, 0.6));
    } else {
      const side = backwards ? -1 : 1;
      const far = 1.9 * length + towed;
      camera.position.copy(ahead(middle - side * far, -0.35 * length, 0.72 * length + 0.3 * towed));
      camera.position.z = Math.max(camera.position.z, height(camera.position.x, camera.position.y) + 1);
      camera.lookAt(ahead(middle + side * 0.8 * length, 0, 0.15 * length));
    }
    camera.updateMatrixWorld();
    camera.updateProjectionMatrix();
    return camera;
  }

  let firstPicture = null;  // time from opening the page to the first rendered frame [ms]
  let shown = { kind: 'follow', apart: false, forces: Boolean(dials) };
  // views in the last rendered frame, as {car, camera, viewport}, for tests and labels
  let views = [];
  const orbit = new THREE.Vector3(-8, -7, 5);

  /** Returns the current distance between two cars [m]. */
  function apartNow(one, other) {
    const [a, b] = [one, other].map((car) => car.solid.root.matrix.elements);
    return Math.hypot(a[12] - b[12], a[13] - b[13], a[14] - b[14]);
  }

  function drawView(car, camera, viewport, others) {
    for (const each of cars) {
      // Hides ghosts near the driver's camera, because they would cover the road.
      const around = shown.kind === 'driver' && each !== car
        && Math.hypot(...['x', 'y'].map((axis) => poseAt(each.track, now)[axis] - poseAt(car.track, now)[axis])) < runs[car.track.run].car.length;
      const visible = each.track.visible && !around;
      // Hides the car itself in the driver's view.
      each.solid.group.visible = visible && each === car && shown.kind !== 'driver';
      each.ghost.group.visible = visible && each !== car && others && each.ghost.fade(apartNow(each, car));
      each.trail.mesh.visible = visible && (others || each === car);
      if (each.skid) each.skid.mesh.visible = each.track.visible && (others || each === car);
    }
    if (dials) {
      if (car.use && shown.forces && shown.kind !== 'driver') dials.show(car.use, wheelPlaces(car.solid, runs[car.track.run].vehicle, height), now);
      else dials.hide();
    }
    if (wind) {
      if (car.wind) wind.show(car.wind, poseAt(car.track, now), now);
      else wind.hide();
    }
    scenery.know(car.track, now);
    const { x, y, width, height: high } = viewport;
    renderer.setViewport(x, y, width, high);
    renderer.setScissor(x, y, width, high);
    renderer.render(scene, camera);
  }

  function draw(time) {
    const [width, high] = [canvas.clientWidth, canvas.clientHeight];
    if (width <= 0 || high <= 0) return;
    // setSize is called only if the size has changed, because every call allocates new buffers.
    if (canvas.width !== Math.floor(width * pixelRatio) || canvas.height !== Math.floor(high * pixelRatio)) {
      renderer.setSize(width, high, false);
    }
    for (const car of cars) {
      car.solid.pose(car.motion, time);
      car.ghost.pose(car.motion, time);
      car.trail.update(time);
      if (car.skid) car.skid.update(time);
    }
    for (const { mesh, shown: isShown } of plans) mesh.visible = isShown(time);
    scenery.update(time);
    const visible = cars.filter(({ track }) => track.visible);
    if (!visible.length) return;
    const apart = shown.apart && visible.length > 1;
    const first = visible.includes(lead) ? lead : visible[visible.length - 1];
    const own = apart ? visible : [first];
    renderer.setScissorTest(true);
    renderer.setScissor(0, 0, width, high);
    renderer.clear();
    const cells = gridOf(own.length, width, high);
    views = own.map((car, i) => {
      const viewport = cells[i];
      const camera = cameraFor(shown.kind, car, time, viewport.width / viewport.height, orbit);
      const { pose } = framing(car, time);
      const z = height(pose.x, pose.y);
      sun.target.position.set(pose.x, pose.y, z);
      sun.position.set(pose.x - 22, pose.y - 30, z + 46);
      drawView(car, camera, viewport, !apart);
      return { car, camera, viewport };
    });
    if (firstPicture === null) firstPicture = performance.now();
  }

  return {
    draw, orbit, lead, renderer,
    set: (change) => { shown = { ...shown, ...change }; },
    kind: () => shown.kind,
    hasForces: Boolean(dials),
    views: () => views,
    firstPicture: () => firstPicture,
    cars,
  };
}

/**
 * Returns the viewports of the views, in several rows if necessary, as {x, y, width, height}. y is
 * measured from the bottom of the canvas.
 */
function gridOf(count, width, height) {
  const GAP = 2;
  const most = Math.min(count, Math.max(1, Math.round(Math.sqrt((count * width) / height / 1.3))));
  const lines = Math.ceil(count / most);
  const columns = Math.ceil(count / lines);
  return d3.range(count).map((i) => {
    const [column, line] = [i % columns, Math.floor(i / columns)];
    // If the last row of views has fewer views than the other rows, its views are wider.
    const inLine = line + 1 < lines ? columns : count - columns * (lines - 1);
    const [x0, x1] = [column, column + 1].map((k) => Math.round((k * width) / inLine));
    const [y0, y1] = [lines - 1 - line, lines - line].map((k) => Math.round((k * height) / lines));
    return {
      x: x0, y: y0 + (line + 1 < lines ? GAP : 0),
      width: x1 - x0 - (column + 1 < inLine ? GAP : 0), height: y1 - y0 - (line + 1 < lines ? GAP : 0),
    };
  });
}

/** Returns the state of a track at a time as text, such as "4.62 m/s, 1.31 m right of the path". */
function stateText(track, time) {
  const moment = Math.min(time, track.log.t[track.log.t.length - 1]);
  const [speed, off] = [valueAt(track, 'speed', moment), valueAt(track, 'cross_track', moment)];
  const over = track.end.t !== undefined && time >= track.end.t - 1e-6 && track.end.status !== 'arrived';
  return [
    `${fixed(speed, 1)} m/s`,
    off !== null && (Math.abs(off) < 0.005 ? 'on the path' : `${fixed(Math.abs(off), 2)} m ${off < 0 ? 'right' : 'left'} of the path`),
    over && statusText(track.end.status),
  ].filter(Boolean).join(', ');
}

/** Draws the legend of the colors in the scene. */
function drawSceneKey(parent) {
  const key = parent.append('p').attr('class', 'key');
  const sign = (name, style, kind = 'line') => {
    const entry = key.append('span').attr('class', 'sign');
    const swatch = entry.append('span').attr('class', `swatch ${kind}`);
    for (const [property, value] of Object.entries(style)) swatch.style(property, value);
    entry.append('span').text(name);
  };
  const worlds = runs.map((run) => run.world);
  if (runs.some((run) => run.plan && run.plan.line)) sign('plan', { 'border-top': '3px dashed #d8b400' });
  for (const track of tracks) sign(`driven, ${track.label}`, { 'border-top': `4px solid ${track.css}` });
  for (const track of tracks.filter((one) => one.newPlans.length)) sign(`new plan, ${track.label}`, { 'border-top': `3px dashed ${track.css}` });
  const patches = worlds.flatMap(({ friction, patches: own }) => own.map((patch) => patch.friction < friction));
  if (patches.includes(true)) sign('less friction', { background: '#c4e2f2' }, 'area');
  if (patches.includes(false)) sign('more friction', { background: '#55524e' }, 'area');
  if (worlds.some((world) => world.walls)) sign('map', { background: '#b5b0a8' }, 'area');
  if (worlds.some((world) => world.obstacles.length)) sign('obstacle', { background: '#c9a24a' }, 'area');
  if (worlds.some((world) => world.obstacles.some((box) => box.known_later))) sign('obstacle not known yet', { border: '2px solid #7a5a10' }, 'area');
  if (replay.cars.some(({ skid }) => skid)) sign(`tyre beyond ${100 * SKID.use} % of its grip`, { 'border-top': '4px solid #15161a' });
  if (replay.hasForces) sign('tyre force in the circle of its grip', { border: '2px solid #8d959c', 'border-radius': '50%' }, 'round');
  if (replay.cars.some((car) => car.wind)) sign('wind', { background: '#cfc6f2' }, 'area');
  if (worlds.some((world) => (world.gusts || []).length)) sign('area of a gust', { border: '2px solid #8f74e8' }, 'area');
}

let replay = null;

function drawReplay(parent) {
  if (!tracks.length || !runs.every((run) => run.vehicle)) return;
  const made = parent.append('section').attr('id', 'replay').attr('aria-label', 'Replay');
  if (!sceneContext) {
    made.append('p').attr('class', 'hint').text('This browser has no WebGL, which the replay in three dimensions needs; the map below shows the same.');
    return;
  }
  parent.classed('with-replay', true);
  const panel = made.append('div').attr('class', 'panel replay');
  const frame = panel.append('div').attr('class', 'stage');
  const canvas = frame.append(() => sceneCanvas).attr('tabindex', 0).attr('role', 'img')
    .attr('aria-label', `Replay in three dimensions of ${tracks.map(({ label }) => label).join(', ')}; the map and the charts show the same.`);
  const labels = frame.append('div').attr('class', 'labels');
  try {
    replay = makeReplay(sceneCanvas, sceneContext);
  } catch (error) {
    panel.remove();
    parent.classed('with-replay', false);
    made.append('p').attr('class', 'hint').text('The replay in three dimensions cannot be drawn; the map below shows the same.');
    return;
  }

  const tools = panel.append('div').attr('class', 'tools');
  drawPlayButton(tools);
  const cameras = tools.append('span').attr('class', 'choice').attr('role', 'group').attr('aria-label', 'Camera');
  const choose = (kind) => {
    replay.set({ kind });
    cameras.selectAll('button').attr('aria-pressed', function pressed() { return String(this.value === kind); });
    update();
  };
  for (const [kind, name] of CAMERAS) {
    cameras.append('button').attr('type', 'button').attr('value', kind).attr('aria-pressed', String(kind === 'follow'))
      .text(name).on('click', () => choose(kind));
  }
  if (tracks.length > 1) {
    const apart = tools.append('button').attr('type', 'button').attr('id', 'side-by-side').attr('aria-pressed', 'false').text('Side by side');
    apart.on('click', () => {
      const on = apart.attr('aria-pressed') !== 'true';
      apart.attr('aria-pressed', String(on));
      replay.set({ apart: on });
      update();
    });
  }
  if (replay.hasForces) {
    const forces = tools.append('button').attr('type', 'button').attr('id', 'tyre-forces').attr('aria-pressed', 'true').text('Tyre forces');
    forces.on('click', () => {
      const on = forces.attr('aria-pressed') !== 'true';
      forces.attr('aria-pressed', String(on));
      replay.set({ forces: on });
      update();
    });
  }
  drawEventTrack(panel);
  drawSceneKey(panel);

  // Dragging with the mouse moves the camera around the car.
  const eye = new THREE.PerspectiveCamera();
  eye.up.set(0, 0, 1);
  eye.position.copy(replay.orbit);
  const controls = new THREE.OrbitControls(eye, canvas.node());
  Object.assign(controls, { enablePan: false, enableKeys: false, minDistance: 3, maxDistance: 150, maxPolarAngle: 0.49 * Math.PI, enableZoom: false });
  controls.addEventListener('change', () => {
    replay.orbit.copy(eye.position);
    update();
  });
  controls.addEventListener('start', () => replay.kind() === 'orbit' || choose('orbit'));
  canvas.on('keydown', () => {
    const steps = { ArrowLeft: -0.1, ArrowRight: 0.1, PageUp: -1, PageDown: 1 };
    const step = steps[d3.event.key];
    if (step === undefined) return;
    d3.event.preventDefault();
    setTime(now + step);
  });

  /** Draws the scene at most once per frame. */
  let waiting = false;
  function update() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      replay.draw(now);
      const views = replay.views();
      const high = canvas.node().clientHeight;
      const boxes = labels.selectAll('div').data(views);
      boxes.exit().remove();
      boxes.enter().append('div').merge(boxes)
        .style('left', ({ viewport }) => `${viewport.x + 10}px`)
        .style('top', ({ viewport }) => `${high - viewport.y - viewport.height + 10}px`)
        .style('max-width', ({ viewport }) => `${viewport.width - 20}px`)
        .each(function fill({ car }) {
          const ghosts = views.length > 1 ? [] : tracks.filter((track) => track.visible && track !== car.track);
          const wind = car.wind && car.wind(now);
          const lines = d3.select(this).selectAll('p').data([
            { name: car.track.label, css: car.track.css, text: stateText(car.track, now) },
            ...ghosts.slice(0, MOST_NAMED).map((track) => ({ name: track.label, css: track.css, text: stateText(track, now), ghost: true })),
            ...(ghosts.length > MOST_NAMED ? [{ name: `and ${ghosts.length - MOST_NAMED} more`, text: '' }] : []),
            ...(wind && wind.speed >= 0.05 ? [{ name: 'wind', text: `${fixed(wind.speed, 1)} m/s` }] : []),
          ]);
          lines.exit().remove();
          const made = lines.enter().append('p');
          made.append('span').attr('class', 'dot');
          made.append('span').attr('class', 'name');
          made.append('span').attr('class', 'state');
          const all = made.merge(lines).classed('ghost', ({ ghost }) => Boolean(ghost));
          all.select('.dot').style('color', ({ css }) => css || 'transparent');
          all.select('.name').text(({ name }) => name);
          all.select('.state').text(({ text, ghost }) => text + (ghost ? ' (translucent)' : ''));
        });
    });
  }
  // Browsers do not print a WebGL canvas, so an image replaces the canvas in print.
  const still = frame.append('img').attr('class', 'still').attr('alt', '');
  window.addEventListener('beforeprint', () => {
    replay.draw(now);
    still.attr('src', canvas.node().toDataURL('image/jpeg', 0.9));
  });
  bus.on('time.replay', update);
  bus.on('visibility.replay', update);
  bus.on('scheme.replay', update);
  new ResizeObserver(update).observe(canvas.node());
}
