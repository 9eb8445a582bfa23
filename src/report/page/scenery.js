// Creates the scenery of the 3D scene: ground, road, friction patches, obstacles, cones, trees.
// 1. Each function returns meshes of one kind, in the coordinates of the run's world.
// 2. Heights come from the height samples of the ground that the report contains.
// 3. Trees stand at pseudo-random places that are the same on every page, and keep away from the
//    road.

const ROAD = { dash: 3, gap: 6, line: 0.12, post: 10 };  // [m]

/**
 * Returns a deterministic pseudo-random number in [0, 1), so that the scenery is the same on every
 * page.
 */
function scattered(n) {
  const x = Math.sin(n * 127.1 + 311.7) * 43758.5453;
  return x - Math.floor(x);
}

/**
 * Returns a function that gives the elevation of the ground at a point, interpolated in the run's
 * elevation grid.
 */
function heightOf(ground) {
  if (!ground) return () => 0;
  const z = numbersOf(ground.z);
  const { columns, step } = ground;
  const lines = z.length / columns;
  return (x, y) => {
    const u = Math.min(Math.max((x - ground.x) / step, 0), columns - 1.001);
    const v = Math.min(Math.max((y - ground.y) / step, 0), lines - 1.001);
    const [i, j] = [Math.floor(u), Math.floor(v)];
    const [a, b] = [u - i, v - j];
    const at = (k, l) => z[(j + l) * columns + i + k];
    return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
  };
}

/** Makes a grainy texture, on which motion over a surface is visible. */
function grain(light, spread, repeat) {
  const size = 128;
  const pixels = new Uint8Array(3 * size * size);
  for (let i = 0; i < size * size; ++i) {
    // The texture has fine grain, and also coarse grain of 4 by 4 texels, which remains visible
    // from a distance.
    const coarse = scattered(7919 + Math.floor((i % size) / 4) + 64 * Math.floor(i / size / 4));
    const shade = 1 + spread * (0.75 * scattered(i) + 0.35 * coarse - 0.55);
    for (let c = 0; c < 3; ++c) pixels[3 * i + c] = Math.min(255, 255 * light[c] * shade);
  }
  const texture = new THREE.DataTexture(pixels, size, size, THREE.RGBFormat);
  texture.wrapS = THREE.RepeatWrapping;
  texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.set(repeat, repeat);
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipMapLinearFilter;
  texture.generateMipmaps = true;
  // degree of anisotropic filtering; larger values are slow without graphics hardware
  texture.anisotropy = 2;
  texture.needsUpdate = true;
  return texture;
}

/**
 * Returns evenly spaced points along a line, as {x, y, nx, ny}, where (nx, ny) is the unit normal
 * to the left.
 */
function evenly(line, step) {
  const points = [];
  let left = 0;
  for (let i = 0; i + 1 < line.x.length; ++i) {
    const [dx, dy] = [line.x[i + 1] - line.x[i], line.y[i + 1] - line.y[i]];
    const length = Math.hypot(dx, dy);
    for (; left <= length && length > 0; left += step) {
      points.push({ x: line.x[i] + (dx * left) / length, y: line.y[i] + (dy * left) / length, nx: -dy / length, ny: dx / length });
    }
    left -= length;
  }
  return points;
}

/**
 * Makes a strip on the ground along a line. The edges of the strip are at two offsets to the left
 * of the points [m]. `shares` adds fractions of each point's `width` to the offsets. `keep` selects
 * the pieces to draw.
 */
function strip(points, from, to, height, lift, keep = () => true, shares = [0, 0]) {
  const positions = [];
  const uvs = [];
  const indices = [];
  points.forEach(({ x, y, nx, ny, width }, i) => {
    for (const [side, base] of [from, to].entries()) {
      const offset = base + (shares[side] && shares[side] * width);
      const [px, py] = [x + offset * nx, y + offset * ny];
      positions.push(px, py, height(px, py) + lift);
      uvs.push(px / 2, py / 2);
    }
    if (i > 0 && keep(i)) {
      const k = 2 * i;
      indices.push(k - 2, k, k - 1, k - 1, k, k + 1);
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs, 2));
  geometry.setIndex(indices);
  geometry.computeVertexNormals();
  return geometry;
}

/**
 * Makes a flat mesh on the ground. Meshes with a higher `level` are drawn above those with a lower
 * level, without flickering.
 */
function flat(geometry, color, level, more = {}) {
  const material = new THREE.MeshLambertMaterial({
    color, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: -level, polygonOffsetUnits: -4 * level, ...more,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = level;
  mesh.receiveShadow = true;
  return mesh;
}

function groundMesh(ground, extent) {
  const material = new THREE.MeshLambertMaterial({ map: grain([0.70, 0.76, 0.58], 0.2, 1) });
  let geometry;
  if (ground) {
    const z = numbersOf(ground.z);
    const lines = z.length / ground.columns;
    const positions = [];
    const uvs = [];
    const indices = [];
    z.forEach((height, i) => {
      const [x, y] = [ground.x + ground.step * (i % ground.columns), ground.y + ground.step * Math.floor(i / ground.columns)];
      positions.push(x, y, height);
      uvs.push(x / 6, y / 6);
    });
    for (let j = 0; j + 1 < lines; ++j) {
      for (let i = 0; i + 1 < ground.columns; ++i) {
        const k = j * ground.columns + i;
        indices.push(k, k + 1, k + ground.columns, k + 1, k + ground.columns + 1, k + ground.columns);
      }
    }
    geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs, 2));
    geometry.setIndex(indices);
    geometry.computeVertexNormals();
  } else {
    const size = 2400;
    geometry = new THREE.PlaneBufferGeometry(size, size);
    const uv = geometry.attributes.uv;
    for (let i = 0; i < uv.count; ++i) uv.setXY(i, (uv.getX(i) * size) / 6, (uv.getY(i) * size) / 6);
    geometry.translate((extent.x[0] + extent.x[1]) / 2, (extent.y[0] + extent.y[1]) / 2, 0);
  }
  const mesh = new THREE.Mesh(geometry, material);
  mesh.receiveShadow = true;
  // Level ground is drawn first and not written to the depth buffer, whose resolution is too coarse
  // for such a large plane.
  material.depthWrite = Boolean(ground);
  mesh.renderOrder = -1;
  return mesh;
}

/** Makes the asphalt along a line, with edge lines, dashed lane lines and posts. */
function roadMeshes(line, { width, lanes }, height) {
  const points = evenly(line, 0.5);
  if (points.length < 3) return [];
  const half = width / 2;
  const paint = 0xf4f4ee;
  const glow = { emissive: new THREE.Color(paint), emissiveIntensity: 0.3 };
  const dash = (ROAD.dash + ROAD.gap) * 2;
  const meshes = [
    flat(strip(points, -half - 0.4, half + 0.4, height, 0.004), 0xffffff, 1, { map: grain([0.52, 0.52, 0.53], 0.2, 1) }),
    flat(strip(points, half - ROAD.line, half, height, 0.008), paint, 2, glow),
    flat(strip(points, -half, -half + ROAD.line, height, 0.008), paint, 2, glow),
    ...d3.range(1, lanes).map((lane) => {
      const middle = -half + (width * lane) / lanes;
      return flat(strip(points, middle - ROAD.line / 2, middle + ROAD.line / 2, height, 0.008, (i) => i % dash < 2 * ROAD.dash), paint, 2, glow);
    }),
  ];
  const spots = points.filter((_, i) => i % (2 * ROAD.post) === 0)
    .flatMap(({ x, y, nx, ny }) => [1, -1].map((side) => [x + side * (half + 1.1) * nx, y + side * (half + 1.1) * ny]));
  const posts = new THREE.InstancedMesh(new THREE.BoxBufferGeometry(0.12, 0.12, 1), new THREE.MeshLambertMaterial({ color: 0xf2f0e8, emissive: 0x555550 }), spots.length);
  const place = new THREE.Matrix4();
  spots.forEach(([x, y], i) => posts.setMatrixAt(i, place.makeTranslation(x, y, height(x, y) + 0.5)));
  posts.castShadow = true;
  posts.frustumCulled = false;
  return [...meshes, posts];
}

/**
 * Makes the asphalt between the edges of a track, with edge lines and a start line. Both edges of
 * the track must have the same number of points.
 */
function trackMeshes({ left, right }, height) {
  const points = [...right.x.keys(), 0].map((i) => {
    const [dx, dy] = [left.x[i] - right.x[i], left.y[i] - right.y[i]];
    const width = Math.hypot(dx, dy);
    return { x: right.x[i], y: right.y[i], nx: dx / width, ny: dy / width, width };
  });
  const paint = 0xf4f4ee;
  const glow = { emissive: new THREE.Color(paint), emissiveIntensity: 0.3 };
  const all = () => true;
  const line = { x: [right.x[0], left.x[0]], y: [right.y[0], left.y[0]] };
  return [
    flat(strip(points, -0.4, 0.4, height, 0.004, all, [0, 1]), 0xffffff, 1, { map: grain([0.52, 0.52, 0.53], 0.2, 1) }),
    flat(strip(points, 0, ROAD.line, height, 0.008), paint, 2, glow),
    flat(strip(points, -ROAD.line, 0, height, 0.008, all, [1, 1]), paint, 2, glow),
    flat(strip(evenly(line, 0.5), -0.15, 0.15, height, 0.008), paint, 2, glow),
  ];
}

/**
 * Makes strips on the ground between pairs of lines, in one geometry. Both lines of a pair must
 * have the same number of points, listed as x, y, x, y, ...
 */
function bandsGeometry(bands, height, lift) {
  const positions = [];
  const uvs = [];
  const indices = [];
  for (const { left, right } of bands) {
    for (let i = 0; i + 1 < left.length; i += 2) {
      const k = positions.length / 3;
      for (const [x, y] of [[left[i], left[i + 1]], [right[i], right[i + 1]]]) {
        positions.push(x, y, height(x, y) + lift);
        uvs.push(x / 2, y / 2);
      }
      if (i > 0) indices.push(k - 2, k - 1, k, k - 1, k + 1, k);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute('uv', new THREE.Float32BufferAttribute(uvs, 2));
  geometry.setIndex(indices);
  geometry.computeVertexNormals();
  return geometry;
}

/** Returns the two edges of a painted line. */
function bandOfLine({ points, width }) {
  const band = { left: [], right: [] };
  const last = points.length - 2;
  for (let i = 0; i <= last; i += 2) {
    const [a, b] = [Math.max(0, i - 2), Math.min(last, i + 2)];
    const [dx, dy] = [points[b] - points[a], points[b + 1] - points[a + 1]];
    const reach = width / 2 / (Math.hypot(dx, dy) || 1);
    band.left.push(points[i] - reach * dy, points[i + 1] + reach * dx);
    band.right.push(points[i] + reach * dy, points[i + 1] - reach * dx);
  }
  return band;
}

/** Makes the pavement and road marks of a road network. */
function networkMeshes({ bands, lines }, height) {
  const painted = (yellow, paint) => flat(bandsGeometry(lines.filter((line) => line.yellow === yellow).map(bandOfLine), height, 0.008),
    paint, 2, { emissive: new THREE.Color(paint), emissiveIntensity: 0.3 });
  return [
    flat(bandsGeometry(bands, height, 0.004), 0xffffff, 1, { map: grain([0.52, 0.52, 0.53], 0.2, 1) }),
    painted(false, 0xf4f4ee),
    painted(true, 0xe5b833),
  ];
}

/** Makes trees at places away from roads, driven paths and obstacles. */
function treeMeshes(extent, busy, height) {
  const MOST = 160;
  const CLEAR = 14;  // [m]
  const cells = new Set();
  for (const [x, y] of busy) {
    for (let i = -1; i <= 1; ++i) for (let j = -1; j <= 1; ++j) cells.add(`${Math.round(x / CLEAR) + i},${Math.round(y / CLEAR) + j}`);
  }
  const spots = [];
  const [width, depth] = [extent.x[1] - extent.x[0] + 160, extent.y[1] - extent.y[0] + 160];
  for (let n = 0; spots.length < MOST && n < 4 * MOST; ++n) {
    const x = extent.x[0] - 80 + width * scattered(2 * n + 1);
    const y = extent.y[0] - 80 + depth * scattered(2 * n + 2);
    if (!cells.has(`${Math.round(x / CLEAR)},${Math.round(y / CLEAR)}`)) spots.push([x, y, 4 + 6 * scattered(n + 0.5)]);
  }
  const crown = new THREE.InstancedMesh(new THREE.ConeBufferGeometry(0.3, 0.9, 8).toNonIndexed().rotateX(Math.PI / 2).translate(0, 0, 0.6),
    new THREE.MeshLambertMaterial({ color: 0x9cbb88 }), spots.length);
  const place = new THREE.Matrix4();
  spots.forEach(([x, y, size], i) => crown.setMatrixAt(i,
    place.compose(new THREE.Vector3(x, y, height(x, y) - 0.15 * size), new THREE.Quaternion(), new THREE.Vector3(size, size, size))));
  crown.castShadow = true;
  crown.frustumCulled = false;
  return [crown];
}

/** Makes a rectangle on the ground, subdivided so that it follows the elevation. */
function areaGeometry({ x, y, yaw, length, width }, height, lift) {
  const count = Math.max(2, Math.min(80, Math.ceil(length / 2)));
  const points = d3.range(count + 1).map((i) => {
    const along = length * (i / count - 0.5);
    return { x: x + along * Math.cos(yaw), y: y + along * Math.sin(yaw), nx: -Math.sin(yaw), ny: Math.cos(yaw) };
  });
  return strip(points, -width / 2, width / 2, height, lift);
}

/** Makes the walls of a map that are near the run. Worlds with a map have flat ground. */
function wallsMesh({ yaw, height, boxes }, extent) {
  const SEEN = 150;  // [m]
  const near = boxes.filter(([x, y, length, width]) => {
    const reach = SEEN + Math.hypot(length, width) / 2;
    return x > extent.x[0] - reach && x < extent.x[1] + reach && y > extent.y[0] - reach && y < extent.y[1] + reach;
  });
  const mesh = new THREE.InstancedMesh(new THREE.BoxBufferGeometry(1, 1, 1),
    new THREE.MeshLambertMaterial({ color: 0xb5b0a8 }), near.length);
  const place = new THREE.Matrix4();
  const turn = new THREE.Quaternion().setFromAxisAngle(new THREE.Vector3(0, 0, 1), yaw);
  near.forEach(([x, y, length, width], i) => mesh.setMatrixAt(i,
    place.compose(new THREE.Vector3(x, y, height / 2), turn, new THREE.Vector3(length, width, height))));
  mesh.castShadow = true;
  mesh.receiveShadow = true;
  mesh.frustumCulled = false;
  return mesh;
}

/** Returns the distance that an obstacle drives forward through its poses; negative if it drives backward. */
function driven(motion) {
  return d3.sum(d3.pairs(motion), ([from, to]) =>
    Math.cos(from[3]) * (to[1] - from[1]) + Math.sin(from[3]) * (to[2] - from[2]));
}

/**
 * Makes the shape of an obstacle: a car if the obstacle moves and has the size of a car, otherwise
 * a box.
 */
function obstacleShape(box, make) {
  const [moves, isCar] = [isMoving(box), box.length > 3 && box.length < 6 && box.width > 1.4 && box.width < 2.3];
  const { car } = runs[0];
  if (!(moves && isCar && make)) {
    const mesh = new THREE.Mesh(new THREE.BoxBufferGeometry(box.length, box.width, box.height), new THREE.MeshLambertMaterial({ color: 0xc9a24a }));
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.position.z = box.height / 2;
    return mesh;
  }
  const vehicle = make({ color: '#c9a24a', ghost: false });
  const still = { t: [0], channels: { x_m: [0], y_m: [0], z_m: [0], qw: [1], qx: [0], qy: [0], qz: [0] } };
  vehicle.pose(still, 0);
  const [along, across] = [box.length / car.length, box.width / car.width];
  vehicle.group.scale.set(along, across, 0.5 * (along + across));
  vehicle.group.position.x = -along * (car.length / 2 - car.rear_overhang);
  // The model of a vehicle faces along the x axis. If the obstacle moves against its x axis, the
  // car model is turned around.
  const backward = box.motion ? driven(box.motion) < 0 : Math.cos(Math.atan2(box.vy, box.vx) - box.yaw) < 0;
  const facing = backward ? Math.PI : 0;
  const holder = new THREE.Group();
  vehicle.group.position.applyAxisAngle(new THREE.Vector3(0, 0, 1), facing);
  vehicle.group.rotation.z = facing;
  holder.add(vehicle.group);
  return holder;
}

/**
 * Makes an obstacle of the world. Until the planner detects the obstacle, only the edges of its box
 * are drawn.
 */
function makeObstacle(scene, box, height, make) {
  const node = new THREE.Group();
  node.rotation.z = box.yaw;
  const solid = obstacleShape(box, make);
  node.add(solid);
  let edges = null;
  if (box.known_later) {
    edges = new THREE.LineSegments(new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(box.length, box.width, box.height)),
      new THREE.LineBasicMaterial({ color: 0x7a5a10 }));
    edges.position.z = box.height / 2;
    node.add(edges);
  }
  scene.add(node);
  const place = (time) => {
    const { x, y, yaw } = obstaclePose(box, time);
    node.position.set(x, y, height(x, y));
    node.rotation.z = yaw;
  };
  place(0);
  return {
    place,
    know: (known) => {
      solid.visible = known || !edges;
      if (edges) edges.visible = !known;
    },
  };
}

function drawScenery(scene, height, makers) {
  const extent = extentOfMap();
  const [first] = runs;
  scene.add(groundMesh(first.ground, extent));
  const busy = [];
  const take = (line) => line.x.forEach((x, i) => i % 5 === 0 && busy.push([x, line.y[i]]));
  for (const track of tracks) take(track.log);
  const lines = new Set();
  for (const run of runs) {
    const line = run.plan && run.plan.line;
    if (!line || !run.plan.road || lines.has(JSON.stringify(line))) continue;
    lines.add(JSON.stringify(line));
    take(line);
    const { edges, road } = run.plan;
    if (edges) [edges.left, edges.right].forEach(take);
    for (const mesh of edges ? trackMeshes(edges, height) : roadMeshes(line, road, height)) scene.add(mesh);
  }
  const once = new Set();
  const fresh = (thing) => !once.has(JSON.stringify(thing)) && once.add(JSON.stringify(thing));
  const obstacles = [];
  for (const { roads } of runs.map((run) => run.world).filter((own) => own.roads && fresh(own.roads))) {
    for (const { left } of roads.bands) left.forEach((x, i) => i % 2 === 0 && busy.push([x, left[i + 1]]));
    for (const mesh of networkMeshes(roads, height)) scene.add(mesh);
  }
  for (const [r, { world, plan }] of runs.entries()) {
    for (const patch of world.patches.filter(fresh)) {
      const icy = patch.friction < world.friction;
      scene.add(flat(areaGeometry(patch, height, 0.012), icy ? 0xd3ecfa : 0x3c3a38, 3, { transparent: true, opacity: 0.62 }));
    }
    for (const [i, box] of world.obstacles.entries()) {
      if (!fresh(box)) continue;
      busy.push([box.x, box.y]);
      obstacles.push({ run: r, index: i, box, shape: makeObstacle(scene, box, height, makers[r]) });
    }
    if (world.walls && fresh(world.walls)) scene.add(wallsMesh(world.walls, extent));
    for (const cone of ((plan && plan.cones) || []).filter(fresh)) {
      const mesh = new THREE.Mesh(new THREE.ConeBufferGeometry(0.16, 0.6, 16).rotateX(Math.PI / 2),
        new THREE.MeshLambertMaterial({ color: 0xe8641b }));
      mesh.position.set(cone[0], cone[1], height(...cone) + 0.3);
      mesh.castShadow = true;
      scene.add(mesh);
    }
  }
  // The scene has no trees if the world has a map. While a run without a plan is in progress, there
  // are no trees either, because trees might stand on the still unknown path.
  const hasTrees = !runs.some((run) => run.world.walls) && (!data.live || runs.some((run) => run.plan && run.plan.line));
  if (hasTrees) for (const mesh of treeMeshes(extent, busy, height)) scene.add(mesh);
  return {
    update: (time) => obstacles.forEach(({ shape }) => shape.place(time)),
    /**
     * Draws the obstacles that the planner of a track has detected by `time` as solid, and the
     * others as outlines.
     */
    know: (track, time) => {
      for (const { run, index, box, shape } of obstacles) {
        if (!box.known_later) continue;
        const event = run === track.run && track.events.known.find(([which]) => which === index);
        shape.know(event ? time >= event[1] : run !== track.run || !track.events.known);
      }
    },
  };
}
