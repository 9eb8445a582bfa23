// Draws the grip that each tyre uses in the 3D scene, as size and direction of the tyre's force,
// and draws skid marks.

const WHEELS = ['fl', 'fr', 'rl', 'rr'];
const DIAL = 0.62;  // Radius of the circle in the 3D scene that represents full grip [m].
// Fraction of the grip above which a tyre leaves a skid mark, and width of the tyre [m].
const SKID = { use: 0.9, width: 0.17 };

/**
 * Returns the used fraction of each tyre's grip over time, as {t, at(wheel, time), used(wheel,
 * row)}; null if the log has no tyre forces.
 */
function tyreUse(track) {
  if (!track.tyres) return null;
  const t = numbersOf(track.tyres.t);
  const channels = Object.fromEntries(WHEELS.map((wheel) => [wheel, {
    along: numbersOf(track.tyres[wheel].along), across: numbersOf(track.tyres[wheel].across),
  }]));
  return {
    t,
    at: (wheel, time) => ({
      along: interpolated(t, channels[wheel].along, time), across: interpolated(t, channels[wheel].across, time),
    }),
    used: (wheel, row) => Math.hypot(channels[wheel].along[row], channels[wheel].across[row]),
  };
}

/**
 * Returns the position {x, y, z, yaw} on the ground below each wheel, by the wheel's name. Wheels
 * high above the ground are omitted.
 */
function wheelPlaces(vehicle, model, height) {
  const places = {};
  for (const wheel of WHEELS) {
    const i = model.bodies.findIndex((body) => body.joints.some(({ channel }) => channel === `spin_${wheel}_rad`));
    if (i < 0) continue;
    const { elements } = vehicle.nodes[i].matrix;
    // The wheel's y axis is the spin axis, so the direction of the y axis does not depend on the
    // spin angle. The wheel's forward direction is 90 degrees to the right of the y axis.
    const yaw = Math.atan2(-elements[4], elements[5]);
    const [x, y] = [elements[12], elements[13]];
    if (elements[14] - height(x, y) > 0.5) continue;  // a wheel in the air is skipped
    places[wheel] = { x, y, z: height(x, y), yaw };
  }
  return places;
}

/** Makes a flat arrow of length 1 along x. */
function arrowGeometry() {
  const shape = new THREE.Shape();
  for (const [i, [x, y]] of [[0, 0.07], [0.62, 0.07], [0.62, 0.2], [1, 0], [0.62, -0.2], [0.62, -0.07], [0, -0.07]].entries()) {
    if (i === 0) shape.moveTo(x, y);
    else shape.lineTo(x, y);
  }
  return new THREE.ShapeBufferGeometry(shape);
}

/**
 * Makes a circle on the ground below each wheel, whose radius represents full grip, with the tyre
 * force as an arrow.
 */
function makeDials(scene) {
  const ring = new THREE.RingBufferGeometry(DIAL - 0.03, DIAL, 48);
  const disc = new THREE.CircleBufferGeometry(DIAL, 48);
  const arrow = arrowGeometry();
  // Creates a material that is visible through the car.
  const over = (color, opacity) => new THREE.MeshBasicMaterial({ color, transparent: true, opacity, depthTest: false, depthWrite: false, side: THREE.DoubleSide });
  const dials = WHEELS.map(() => {
    const group = new THREE.Group();
    const force = new THREE.Mesh(arrow, over(0xffffff, 1));
    force.renderOrder = 32;
    for (const [geometry, material, order] of [[disc, over(0x0c1014, 0.28), 30], [ring, over(0xffffff, 0.9), 31]]) {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.renderOrder = order;
      group.add(mesh);
    }
    group.add(force);
    scene.add(group);
    return { group, force };
  });
  return {
    hide: () => dials.forEach(({ group }) => { group.visible = false; }),
    show: (use, places, time) => WHEELS.forEach((wheel, i) => {
      const { group, force } = dials[i];
      group.visible = Boolean(places[wheel]);
      if (!group.visible) return;
      const { x, y, z, yaw } = places[wheel];
      const { along, across } = use.at(wheel, time);
      const share = Math.min(1.15, Math.hypot(along, across));
      group.position.set(x, y, z + 0.03);
      group.rotation.z = yaw;
      force.visible = share > 0.02;
      force.rotation.z = Math.atan2(across, along);
      force.scale.set(DIAL * share, DIAL * Math.min(1, 0.4 + share), 1);
      force.material.color.set(d3.interpolatePlasma(0.45 + 0.5 * Math.min(1, share)));
    }),
  };
}

/** Makes skid marks where tyres use nearly all of their grip. The marks grow with time. */
function makeSkidMarks(track, vehicle, motion, model, height) {
  const use = tyreUse(track);
  if (!use) return null;
  const positions = [];
  const times = [];
  const before = {};
  for (let row = 0; row < use.t.length; ++row) {
    const sliding = WHEELS.filter((wheel) => use.used(wheel, row) > SKID.use);
    if (!sliding.length && !Object.keys(before).length) continue;
    vehicle.pose(motion, use.t[row]);
    const places = wheelPlaces(vehicle, model, height);
    for (const wheel of WHEELS) {
      const place = places[wheel];
      if (!place || !sliding.includes(wheel)) {
        delete before[wheel];
        continue;
      }
      const from = before[wheel];
      before[wheel] = place;
      const [dx, dy] = from ? [place.x - from.x, place.y - from.y] : [0, 0];
      const length = Math.hypot(dx, dy);
      if (length < 0.02) {
        before[wheel] = from || place;
        continue;
      }
      const [nx, ny] = [(-dy / length) * (SKID.width / 2), (dx / length) * (SKID.width / 2)];
      const corner = (at, side) => [at.x + side * nx, at.y + side * ny, height(at.x + side * nx, at.y + side * ny) + 0.014];
      const [a, b, c, d] = [corner(from, 1), corner(from, -1), corner(place, 1), corner(place, -1)];
      positions.push(...a, ...b, ...c, ...c, ...b, ...d);
      times.push(use.t[row]);
    }
  }
  if (!times.length) return null;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  const mesh = flat(geometry, 0x1b1c20, 5);
  mesh.frustumCulled = false;
  return { mesh, update: (time) => geometry.setDrawRange(0, 6 * d3.bisectRight(times, time)) };
}
