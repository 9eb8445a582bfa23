// Draws the map of a run, with x to the right and y up, in meters.
// 1. The extent of the map contains the plans, the driven paths and the obstacles. The scales of x
//    and y are equal, unless the path is long and narrow.
// 2. The map has these layers, from bottom to top: roads, friction patches, track edges, plans,
//    cones, walls, obstacles, driven paths, cars.
// 3. The driven path of one car is colored by the distance between the cars, or by the cross-track
//    error.
// 4. A button enlarges the displayed distances from the path by the factor LATERAL.
// This file also draws the clock that plays back the run.

function extentOfMap() {
  const xs = [];
  const ys = [];
  const add = (x, y) => { xs.push(x); ys.push(y); };
  for (const run of runs) {
    const line = run.plan && run.plan.line;
    if (line) line.x.forEach((x, i) => add(x, line.y[i]));
    for (const edge of Object.values((run.plan && run.plan.edges) || {})) edge.x.forEach((x, i) => add(x, edge.y[i]));
    for (const cone of (run.plan && run.plan.cones) || []) add(cone[0], cone[1]);
    for (const box of run.world.obstacles) {
      const reach = Math.hypot(box.length, box.width) / 2;
      add(box.x - reach, box.y - reach);
      add(box.x + reach, box.y + reach);
    }
  }
  for (const track of tracks) track.log.x.forEach((x, i) => add(x, track.log.y[i]));
  if (!xs.length) add(0, 0);
  const margin = Math.max(4, 0.03 * Math.min(d3.max(xs) - d3.min(xs), d3.max(ys) - d3.min(ys)));
  return {
    x: [d3.min(xs) - margin, d3.max(xs) + margin],
    y: [d3.min(ys) - margin, d3.max(ys) + margin],
  };
}

/** Whether an obstacle moves. */
const isMoving = (obstacle) => Boolean(obstacle.motion) || obstacle.until !== undefined || obstacle.vx !== 0 || obstacle.vy !== 0;

/** Returns the pose of an obstacle at a time [s]. */
function obstaclePose(obstacle, time) {
  const { motion, until } = obstacle;
  if (time > until) return { x: obstacle.x + 1e6, y: obstacle.y, yaw: obstacle.yaw };
  if (!motion) return { x: obstacle.x + obstacle.vx * time, y: obstacle.y + obstacle.vy * time, yaw: obstacle.yaw };
  const next = Math.min(Math.max(motion.findIndex((pose) => pose[0] > time), 0) || motion.length - 1, motion.length - 1);
  const i = time < motion[0][0] ? 1 : next;
  const [from, to] = [motion[i - 1], motion[i]];
  const share = (time - from[0]) / (to[0] - from[0]);
  const turned = Math.min(Math.max(share, 0), 1);
  return {
    x: from[1] + share * (to[1] - from[1]),
    y: from[2] + share * (to[2] - from[2]),
    yaw: from[3] + turned * Math.atan2(Math.sin(to[3] - from[3]), Math.cos(to[3] - from[3])),
  };
}

function lineText(x, y, count) {
  let text = '';
  for (let i = 0; i < count; ++i) text += `${i ? 'L' : 'M'}${x[i]} ${y[i]}`;
  return text;
}

/** Reverses the order of points in a list x, y, x, y, ... */
function backwards(points) {
  return d3.range(points.length / 2 - 1, -1, -1).flatMap((i) => [points[2 * i], points[2 * i + 1]]);
}

/**
 * Returns the quantity that colors a driven path: {track, points: [{t, value}], most, name}. If
 * cars are compared, the quantity is the distance between the two cars that are furthest apart.
 * Otherwise the quantity is the cross-track error of the car that is furthest from its path.
 */
function shadeOfMap() {
  // the path is not colored while a run is in progress, because the largest value is not yet known
  if (data.live) return null;
  const pair = pairs.filter((one) => one.curve)
    .sort((a, b) => d3.max(b.curve.position) - d3.max(a.curve.position))[0];
  if (pair) {
    const { t, position } = pair.curve;
    return {
      track: pair.first, most: d3.max(position), name: `distance ${pair.label}`,
      points: t.map((time, i) => ({ t: time, value: position[i] })),
    };
  }
  const track = tracks.filter((one) => one.log.cross_track)
    .sort((a, b) => d3.max(b.log.cross_track, Math.abs) - d3.max(a.log.cross_track, Math.abs))[0];
  if (!track) return null;
  return {
    track, most: d3.max(track.log.cross_track, Math.abs), name: `cross-track error, ${track.label}`,
    points: track.log.t.map((time, i) => ({ t: time, value: Math.abs(track.log.cross_track[i]) })),
  };
}

// factor by which the map enlarges distances from the path when the user presses the button for
// this
const LATERAL = 10;

/**
 * Returns the driven path and the pose of a track, with distances from the planned path multiplied
 * by `factor`.
 */
function enlarged(track, factor) {
  const { log } = track;
  const shift = (pose, crossTrack, headingError) => {
    const heading = pose.yaw - headingError;
    const by = (factor - 1) * crossTrack;
    return { x: pose.x - by * Math.sin(heading), y: pose.y + by * Math.cos(heading), yaw: pose.yaw };
  };
  if (factor === 1 || !log.cross_track || !log.heading_error) {
    return { x: log.x, y: log.y, pose: (time) => poseAt(track, time) };
  }
  const points = log.x.map((x, i) => shift({ x, y: log.y[i], yaw: log.yaw[i] }, log.cross_track[i], log.heading_error[i]));
  const end = log.t[log.t.length - 1];
  return {
    x: points.map((point) => point.x),
    y: points.map((point) => point.y),
    pose: (time) => {
      const moment = Math.min(time, end);
      return shift(poseAt(track, moment), valueAt(track, 'cross_track', moment), valueAt(track, 'heading_error', moment));
    },
  };
}

function placed(pose) {
  return `translate(${pose.x} ${pose.y}) rotate(${(pose.yaw * 180) / Math.PI})`;
}

function drawMap(parent) {
  let extent = extentOfMap();
  // Stretches the y direction of the map for long, narrow paths; a lane change, for example, is 150
  // m long and 4 m wide.
  const slender = (extent.x[1] - extent.x[0]) / (extent.y[1] - extent.y[0]);
  const stretch = slender > 6 ? Math.min(8, Math.floor(slender / 3)) : 1;
  const margin = { left: 50, right: 12, top: 52, bottom: 38 };
  const frame = parent.append('div').attr('class', 'map');
  const svg = frame.append('svg').attr('tabindex', 0).attr('role', 'img')
    .attr('aria-label', 'Map of path, obstacles and cars');
  const clip = svg.append('defs').append('clipPath').attr('id', 'map-area').append('rect');
  const xAxis = svg.append('g').attr('class', 'axis x');
  const yAxis = svg.append('g').attr('class', 'axis y');
  const world = svg.append('g').attr('clip-path', 'url(#map-area)').append('g').attr('class', 'world');
  const xName = svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end').text('x [m]');
  const yName = svg.append('text').attr('class', 'axis-name').text(`y [m]${stretch > 1 ? `, stretched ${stretch}×` : ''}`);

  // Elements of the world that are identical in several runs are drawn only once.
  const once = new Set();
  const fresh = (kind, thing) => {
    const key = kind + JSON.stringify(thing);
    return !once.has(key) && once.add(key);
  };
  const box = (selection, area) => selection
    .attr('x', -area.length / 2).attr('y', -area.width / 2)
    .attr('width', area.length).attr('height', area.width);
  const moving = [];
  for (const { roads } of runs.map((run) => run.world).filter((own) => own.roads && fresh('roads', own.roads))) {
    const through = (points) => points.map((value, i) => (i % 2 ? `${value}` : `${i ? 'L' : 'M'}${value} `)).join('');
    const around = ({ left, right }) => `${through(left)}${through(backwards(right)).replace('M', 'L')}Z`;
    world.append('path').attr('class', 'road').attr('d', roads.bands.map(around).join(''));
    for (const yellow of [false, true]) {
      const lines = roads.lines.filter((line) => line.yellow === yellow);
      world.append('path').attr('class', yellow ? 'road-mark yellow' : 'road-mark').attr('d', lines.map((line) => through(line.points)).join(''));
    }
  }
  for (const run of runs) {
    for (const patch of run.world.patches.filter((p) => fresh('patch', p))) {
      box(world.append('rect').attr('class', 'patch').attr('transform', placed(patch)), patch)
        .append('title').text(`friction ${patch.friction}`);
    }
  }
  for (const run of runs) {
    const edges = Object.values((run.plan && run.plan.edges) || {});
    if (edges.length && fresh('edges', run.plan.edges)) {
      const text = edges.map(({ x, y }) => `${lineText(x, y, x.length)}Z`).join('');
      world.append('path').attr('class', 'edges').attr('d', text);
    }
  }
  for (const run of runs) {
    if (run.plan && run.plan.line && fresh('plan', run.plan.line)) {
      const { x, y } = run.plan.line;
      world.append('path').attr('class', 'plan').attr('d', lineText(x, y, x.length));
    }
    for (const cone of ((run.plan && run.plan.cones) || []).filter((c) => fresh('cone', c))) {
      world.append('path').attr('class', 'cone').attr('d', `M${cone[0]} ${cone[1]}h0`);
    }
    const { walls } = run.world;
    if (walls && fresh('walls', walls)) {
      // In a coordinate frame aligned with the rows of the map, each wall is an axis-aligned
      // rectangle.
      const [c, s] = [Math.cos(walls.yaw), Math.sin(walls.yaw)];
      const text = walls.boxes.map(([x, y, length, width]) =>
        `M${c * x + s * y - length / 2} ${c * y - s * x - width / 2}h${length}v${width}h${-length}z`).join('');
      world.append('path').attr('class', 'walls').attr('d', text)
        .attr('transform', `rotate(${(walls.yaw * 180) / Math.PI})`);
    }
    for (const obstacle of run.world.obstacles.filter((o) => fresh('obstacle', o))) {
      const moves = isMoving(obstacle);
      const way = moves && world.append('path').attr('class', 'obstacle-way');
      const shape = world.append('g').attr('class', moves ? 'obstacle moving' : 'obstacle')
        .attr('transform', placed(obstacle));
      box(shape.append('rect'), obstacle);
      if (moves) moving.push({ obstacle, shape, way });
    }
  }

  let factor = 1;
  let ways = tracks.map((track) => enlarged(track, factor));
  const shade = shadeOfMap();
  const shading = world.append('g').attr('class', 'shade');

  function drawShade() {
    shading.selectAll('*').remove();
    if (!shade || !(shade.most > 0)) return;
    const way = ways[shade.track.id];
    // Draws the path in about 300 colored pieces, because more pieces would not be distinguishable.
    const step = Math.max(1, Math.floor(shade.points.length / 300));
    for (let i = 0; i + 1 < shade.points.length; i += step) {
      const next = Math.min(i + step, shade.points.length - 1);
      const [from, to] = [way.pose(shade.points[i].t), way.pose(shade.points[next].t)];
      const value = d3.max(shade.points.slice(i, next + 1), (point) => point.value);
      shading.append('path').attr('d', `M${from.x} ${from.y}L${to.x} ${to.y}`)
        .style('stroke', d3.interpolateCividis(value / shade.most))
        .on('click', () => setTime(shade.points[i].t))
        .append('title').text(`${brief(value)} m at ${brief(shade.points[i].t)} s`);
    }
    shading.style('display', shade.track.visible ? null : 'none');
  }
  drawShade();

  const layers = tracks.map((track) => {
    const layer = world.append('g').attr('class', 'track').style('color', track.css);
    const { x, y } = track.log;
    const way = layer.append('path').attr('class', 'way').attr('d', lineText(x, y, x.length));
    const newPlans = layer.append('g');
    return { layer, way, newPlans, trail: layer.append('path').attr('class', 'trail') };
  });

  /** Draws the elements that grow while a run is in progress. */
  function drawGrown() {
    for (const { obstacle, way } of moving) {
      const end = Math.min(duration, obstacle.until === undefined ? duration : obstacle.until);
      const inner = (obstacle.motion || []).map(([time]) => time).filter((time) => time > 0 && time < end);
      const poses = [0, ...inner, end].map((time) => obstaclePose(obstacle, time));
      way.attr('d', lineText(poses.map(({ x }) => x), poses.map(({ y }) => y), poses.length));
    }
    tracks.forEach((track, i) => {
      const fresh = layers[i].newPlans.selectAll('path').data(track.newPlans).enter();
      fresh.append('path').attr('class', 'new-plan').attr('d', (plan) => lineText(plan.x, plan.y, plan.x.length))
        .append('title').text((plan) => `plan of ${track.label} from ${plan.from} s on`);
    });
  }
  drawGrown();
  const cars = tracks.map((track) => {
    const size = runs[track.run].car;
    const rear = -size.rear_overhang;
    const front = size.length - size.rear_overhang;
    const side = size.width / 2;
    const car = world.append('g').attr('class', 'car').attr('data-track', track.label)
      .style('color', track.css);
    const nose = front - 0.3 * size.length;
    car.append('path').attr('class', 'body')
      .attr('d', `M${rear} ${-side}H${front - 0.3 * side}L${front} ${-0.6 * side}V${0.6 * side}L${front - 0.3 * side} ${side}H${rear}Z`);
    car.append('path').attr('class', 'nose').attr('d', `M${nose} ${-side}L${nose + 0.12 * size.length} 0L${nose} ${side}`);
    car.append('path').attr('class', 'origin').attr('d', 'M0 0h0');
    car.append('title').text(track.label);
    return car;
  });
  // The trailer of each car, in a frame whose origin is the hitch; null for a car without trailer.
  const trailers = cars.map((car, i) => {
    const { trailer } = runs[tracks[i].run].car;
    if (!trailer || !tracks[i].log.hitch_angle) return null;
    const front = trailer.body_ahead - trailer.tongue + trailer.length / 2;
    const side = trailer.width / 2;
    const group = car.append('g').attr('class', 'trailer');
    group.append('path').attr('class', 'body')
      .attr('d', `M0 0H${front}M${front} ${-side}V${side}H${front - trailer.length}V${-side}Z`);
    return { group, hitch: trailer.hitch };
  });

  let size = { width: 0, height: 0 };
  let zoomed = d3.zoomIdentity;

  function redraw() {
    const width = size.width - margin.left - margin.right;
    const height = size.height - margin.top - margin.bottom;
    if (width <= 0 || height <= 0) return;
    const fit = Math.min(width / (extent.x[1] - extent.x[0]), height / (extent.y[1] - extent.y[0]) / stretch);
    const k = fit * zoomed.k;
    const kY = stretch * k;
    const left = zoomed.applyX(margin.left + width / 2 - (fit * (extent.x[0] + extent.x[1])) / 2);
    const base = zoomed.applyY(margin.top + height / 2 + (stretch * fit * (extent.y[0] + extent.y[1])) / 2);
    world.attr('transform', `matrix(${k} 0 0 ${-kY} ${left} ${base})`);
    const right = margin.left + width;
    const bottom = margin.top + height;
    const x = d3.scaleLinear().range([margin.left, right])
      .domain([(margin.left - left) / k, (right - left) / k]);
    const y = d3.scaleLinear().range([bottom, margin.top])
      .domain([(base - bottom) / kY, (base - margin.top) / kY]);
    // Returns axis ticks at round numbers of meters, about 60 pixels apart on either axis.
    const ticks = (scale, perMeter) => {
      const step = d3.tickStep(0, 60 / perMeter, 1);
      return d3.range(Math.ceil(scale.domain()[0] / step), Math.floor(scale.domain()[1] / step) + 1).map((i) => i * step);
    };
    const name = (value) => shown(Number(value.toPrecision(10)));
    clip.attr('x', margin.left).attr('y', margin.top).attr('width', width).attr('height', height);
    xAxis.attr('transform', `translate(0 ${bottom})`)
      .call(d3.axisBottom(x).tickValues(ticks(x, k)).tickFormat(name).tickSize(-height).tickSizeOuter(0).tickPadding(7));
    yAxis.attr('transform', `translate(${margin.left} 0)`)
      .call(d3.axisLeft(y).tickValues(ticks(y, kY)).tickFormat(name).tickSize(-width).tickSizeOuter(0).tickPadding(7));
    xName.attr('x', right).attr('y', size.height - 6);
    yName.attr('x', 12).attr('y', 32);
    svg.attr('data-scale', k);
  }

  const zoom = d3.zoom().scaleExtent([0.5, 400])
    // Touch gestures with one finger and the mouse wheel scroll the page. Two fingers, or the mouse
    // wheel with the Ctrl key, zoom the map.
    .filter(() => {
      const event = d3.event;
      if (event.type === 'wheel') return event.ctrlKey || event.metaKey || document.activeElement === svg.node();
      return event.touches ? event.touches.length > 1 : !event.button;
    })
    .on('zoom', () => { zoomed = d3.event.transform; redraw(); });
  const lasting = (milliseconds) => (window.matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : milliseconds);
  const fitAll = () => svg.transition().duration(lasting(250)).call(zoom.transform, d3.zoomIdentity);
  svg.call(zoom).style('touch-action', 'pan-x pan-y').on('dblclick.zoom', fitAll);
  svg.append('title').text('Drag to pan, Ctrl+wheel or pinch to zoom, double-click to show all.');
  const buttons = frame.append('div').attr('class', 'zoom tools').style('border', 0).style('padding', 0);
  for (const [sign, name, act] of [
    ['+', 'Zoom in', () => svg.transition().duration(lasting(200)).call(zoom.scaleBy, 1.6)],
    ['−', 'Zoom out', () => svg.transition().duration(lasting(200)).call(zoom.scaleBy, 1 / 1.6)],
    ['⤢', 'Show all', fitAll]]) {
    buttons.append('button').attr('type', 'button').attr('title', name).attr('aria-label', name)
      .style('min-width', 0).text(sign).on('click', act);
  }

  if (tracks.some((track) => track.log.cross_track && track.log.heading_error)) {
    const button = buttons.insert('button', ':first-child').attr('type', 'button').attr('id', 'enlarge').attr('aria-pressed', 'false')
      .attr('title', `Distances from the path ${LATERAL} times as large`).text(`lateral ×${LATERAL}`);
    button.on('click', () => {
      factor = factor === 1 ? LATERAL : 1;
      button.attr('aria-pressed', String(factor !== 1));
      ways = tracks.map((track) => enlarged(track, factor));
      layers.forEach(({ way }, i) => way.attr('d', lineText(ways[i].x, ways[i].y, ways[i].x.length)));
      drawShade();
      bus.call('time', null, now, 'map');
    });
  }

  new ResizeObserver(() => {
    const width = frame.node().clientWidth;
    // The height of the map is chosen to fit the path, within the limits of the style sheet.
    const needed = (stretch * (width - margin.left - margin.right) * (extent.y[1] - extent.y[0]))
      / (extent.x[1] - extent.x[0]) + margin.top + margin.bottom;
    frame.style('height', `${Math.max(280, needed)}px`);
    size = { width, height: frame.node().clientHeight };
    redraw();
  }).observe(frame.node());

  bus.on('rows.map', () => {
    extent = extentOfMap();
    ways = tracks.map((track) => enlarged(track, factor));
    layers.forEach(({ way }, i) => way.attr('d', lineText(ways[i].x, ways[i].y, ways[i].x.length)));
    drawGrown();
    redraw();
  });
  bus.on('time.map', (time) => {
    tracks.forEach((track, i) => {
      const pose = ways[i].pose(time);
      cars[i].attr('transform', placed(pose));
      if (trailers[i]) {
        const last = track.log.t[track.log.t.length - 1];
        const angle = valueAt(track, 'hitch_angle', Math.min(time, last));
        trailers[i].group.attr('transform', `translate(${-trailers[i].hitch} 0) rotate(${(180 / Math.PI) * angle})`);
      }
      const { row } = placeAt(track.log, time);
      layers[i].trail.attr('d', `${lineText(ways[i].x, ways[i].y, row + 1)}L${pose.x} ${pose.y}`);
    });
    for (const { obstacle, shape } of moving) {
      shape.attr('transform', placed(obstaclePose(obstacle, time)));
    }
  });
  bus.on('visibility.map', () => tracks.forEach((track, i) => {
    layers[i].layer.style('display', track.visible ? null : 'none');
    cars[i].style('display', track.visible ? null : 'none');
    if (shade && shade.track === track) shading.style('display', track.visible ? null : 'none');
  }));
}

// Plays back the run, with one clock for the whole page.
const playback = { timer: null, speed: 1 };

function stopPlaying() {
  if (playback.timer) playback.timer.stop();
  playback.timer = null;
  bus.call('play', null, false);
}

function togglePlaying() {
  if (playback.timer) {
    stopPlaying();
    return;
  }
  if (now >= duration) setTime(0, 'clock');
  let last = 0;
  playback.timer = d3.timer((elapsed) => {
    setTime(now + ((elapsed - last) / 1000) * playback.speed, 'clock');
    last = elapsed;
    if (now >= duration) stopPlaying();
  });
  bus.call('play', null, true);
}

// Playback of the run stops when the time is set by any other part of the page.
bus.on('time.playback', (time, from) => {
  if (from !== 'clock' && playback.timer) stopPlaying();
});

let clocks = 0;

function drawPlayButton(tools, id) {
  const key = clocks;
  clocks += 1;
  const button = tools.append('button').attr('type', 'button').attr('id', id || null).text('Play').on('click', togglePlaying);
  bus.on(`play.button${key}`, (plays) => button.text(plays ? 'Pause' : 'Play'));
  return button;
}

function drawTimeSlider(tools, name, id) {
  const slider = tools.append('input').attr('type', 'range').attr('min', 0).attr('aria-label', 'Time');
  const setRange = () => slider.attr('max', duration).attr('step', duration / 2000 || 1);
  setRange();
  bus.on(`rows.slider_${name}`, setRange);
  const text = tools.append('output').attr('class', 'time').attr('id', id || null);
  slider.on('input', () => setTime(Number(slider.node().value), `slider ${name}`));
  bus.on(`time.slider_${name}`, (time, from) => {
    if (from !== `slider ${name}`) slider.node().value = time;
    text.text(`t = ${time.toFixed(2)} s`);
  });
}

/** Draws the playback controls and the current time. */
function drawClock(parent) {
  drawEvents(parent);
  if (!replay) drawEventTrack(parent);
  const tools = parent.append('div').attr('class', 'tools');
  drawPlayButton(tools, 'play');
  const speed = tools.append('select').attr('aria-label', 'Playback speed');
  for (const factor of [1, 2, 5, 10]) speed.append('option').attr('value', factor).text(`${factor}×`);
  speed.on('change', () => { playback.speed = Number(speed.node().value); });
  drawTimeSlider(tools, 'map', 'time');
}
