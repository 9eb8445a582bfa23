// Draws the wind in the 3D scene. Arrows on the ground around the car show the velocity of the air
// at the car, and outlines show the areas of gusts.

// Spacing of the arrows [m], number of arrows to each side, smallest wind speed with an arrow
// [m/s], arrow length per wind speed [s], longest arrow [m].
const WIND = { spacing: 6, reach: 3, least: 0.5, perSpeed: 1 / 3, longest: 4.5 };

/**
 * Returns a function that gives the air velocity {x, y, speed} at a car for a time; null if there
 * is no wind.
 */
function windAt(track) {
  const { motion } = runs[track.run].plants.find((plant) => plant.name === track.plant);
  if (!motion.wind) return null;
  const t = numbersOf(motion.t);
  const [xs, ys] = [numbersOf(motion.wind.x), numbersOf(motion.wind.y)];
  return (time) => {
    const [x, y] = [interpolated(t, xs, time), interpolated(t, ys, time)];
    return { x, y, speed: Math.hypot(x, y) };
  };
}

function makeWind(scene, height) {
  const count = (2 * WIND.reach + 1) ** 2;
  const arrows = new THREE.InstancedMesh(arrowGeometry(),
    new THREE.MeshBasicMaterial({ color: 0xf3efff, transparent: true, opacity: 0.8, side: THREE.DoubleSide, depthWrite: false }), count);
  arrows.frustumCulled = false;
  arrows.renderOrder = 20;
  scene.add(arrows);
  const gusts = runs.flatMap(({ world }) => world.gusts || []).map((gust) => {
    const edge = { x: [], y: [] };
    for (const [along, across] of [[1, 1], [1, -1], [-1, -1], [-1, 1], [1, 1]]) {
      const [u, v] = [(along * gust.length) / 2, (across * gust.width) / 2];
      edge.x.push(gust.x + u * Math.cos(gust.yaw) - v * Math.sin(gust.yaw));
      edge.y.push(gust.y + u * Math.sin(gust.yaw) + v * Math.cos(gust.yaw));
    }
    const mesh = flat(strip(evenly(edge, 0.5), -0.08, 0.08, height, 0.02), 0x8f74e8, 6, { emissive: new THREE.Color(0x8f74e8), emissiveIntensity: 0.4 });
    scene.add(mesh);
    return { gust, mesh };
  });
  const matrix = new THREE.Matrix4();
  const up = new THREE.Vector3(0, 0, 1);
  const turn = new THREE.Quaternion();
  return {
    hide: () => { arrows.visible = false; },
    show: (wind, { x, y }, time) => {
      for (const { gust, mesh } of gusts) mesh.visible = time >= gust.from && (gust.to === undefined || time <= gust.to);
      const { x: wx, y: wy, speed } = wind(time);
      arrows.visible = speed >= WIND.least;
      if (!arrows.visible) return;
      const length = Math.min(WIND.longest, Math.max(0.8, WIND.perSpeed * speed));
      turn.setFromAxisAngle(up, Math.atan2(wy, wx));
      const scale = new THREE.Vector3(length, 1.9, 1);
      const [column, row] = [Math.round(x / WIND.spacing), Math.round(y / WIND.spacing)];
      let i = 0;
      for (let du = -WIND.reach; du <= WIND.reach; ++du) {
        for (let dv = -WIND.reach; dv <= WIND.reach; ++dv) {
          const [px, py] = [WIND.spacing * (column + du) - (wx / speed) * (length / 2), WIND.spacing * (row + dv) - (wy / speed) * (length / 2)];
          matrix.compose(new THREE.Vector3(px, py, height(px, py) + 0.12), turn, scale);
          arrows.setMatrixAt(i, matrix);
          i += 1;
        }
      }
      arrows.instanceMatrix.needsUpdate = true;
    },
  };
}
