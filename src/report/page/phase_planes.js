// Draws phase planes with a mark at the current time: longitudinal over lateral acceleration, yaw
// rate over steering angle, and yaw rate over sideslip angle.

const PHASE_PLANES = [
  {
    name: 'g_g', title: 'Acceleration', x: 'lateral_acceleration', y: 'longitudinal_acceleration',
    xName: 'lateral, to the left [m/s²]', yName: 'longitudinal [m/s²]', equal: true,
  },
  {
    name: 'steering_yaw_rate', title: 'Yaw rate against steering', x: 'steering', y: 'yaw_rate',
    xName: 'steering angle [rad]', yName: 'yaw rate [rad/s]',
  },
  {
    name: 'sideslip_yaw_rate', title: 'Yaw rate against sideslip', x: 'sideslip', y: 'yaw_rate',
    xName: 'sideslip angle [rad]', yName: 'yaw rate [rad/s]',
  },
];

/**
 * Returns the largest lateral acceleration that the world's friction permits; null if the runs have
 * different values.
 */
function gripRadius() {
  const radii = new Set(runs.map(({ car, world }) => world.friction * car.grip_acceleration));
  return radii.size === 1 ? Array.from(radii)[0] : null;
}

function drawPhasePlane(parent, plane) {
  const own = tracks.filter((track) => track.log[plane.x] && track.log[plane.y]);
  if (!own.length) return;
  const figure = parent.append('figure').attr('class', 'panel').attr('data-plane', plane.name);
  const caption = figure.append('figcaption').text(plane.title);
  const radius = plane.equal ? gripRadius() : null;
  // Returns the number of log rows before the track's collision or roll-over, or of all rows if
  // there was neither.
  const rowsOfTrack = (track) => (brokenAt(track) === undefined ? track.log.t.length : d3.bisectRight(track.log.t, brokenAt(track)));
  const all = (axis) => own.flatMap((track) => track.log[plane[axis]].slice(0, rowsOfTrack(track)));
  const reach = (axis) => Math.max(1e-6, d3.max(all(axis), Math.abs)) * 1.08;
  let [xMost, yMost] = [reach('x'), reach('y')];
  // While a run is in progress, the range of the accelerations is unknown, so the grip circle is
  // always shown.
  const isShown = radius && (data.live || radius < 3 * Math.max(xMost, yMost));
  const setReach = () => {
    [xMost, yMost] = [reach('x'), reach('y')];
    if (plane.equal) {
      xMost = Math.max(xMost, yMost, isShown ? 1.05 * radius : 0);
      yMost = xMost;
    }
  };
  setReach();
  if (isShown) caption.append('span').text(` circle: µ g = ${brief(radius)} m/s²`);
  const svg = figure.append('svg').attr('role', 'img')
    .attr('aria-label', `${plane.title}: ${plane.yName} over ${plane.xName}, of ${own.map(({ label }) => label).join(', ')}`);
  const margin = { left: 52, right: 12, top: 10, bottom: 40 };
  const xAxis = svg.append('g').attr('class', 'axis x');
  const yAxis = svg.append('g').attr('class', 'axis y');
  const xName = svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end').text(plane.xName);
  const yName = svg.append('text').attr('class', 'axis-name').attr('transform', 'rotate(-90)').attr('text-anchor', 'end').text(plane.yName);
  const circle = isShown ? svg.append('ellipse').attr('class', 'limit') : null;
  const marks = own.map((track) => {
    const layer = svg.append('g').style('color', track.css);
    return { track, layer, line: layer.append('path').attr('class', 'line'), dot: layer.append('circle').attr('class', 'now').attr('r', 4.5) };
  });
  let scales = null;
  const place = () => {
    if (!scales) return;
    for (const { track, dot } of marks) {
      const [x, y] = [valueAt(track, plane.x, now), valueAt(track, plane.y, now)];
      dot.style('display', x === null || y === null ? 'none' : null);
      if (x !== null && y !== null) dot.attr('cx', scales.x(x)).attr('cy', scales.y(y));
    }
  };
  const redraw = () => {
    const { clientWidth: width, clientHeight: height } = svg.node();
    const [w, h] = [width - margin.left - margin.right, height - margin.top - margin.bottom];
    if (w <= 0 || h <= 0) return;
    // If `plane.equal` is set, both axes have the same scale, so the grip limit is a circle.
    const unit = Math.min(w, h) / 2;
    const [xReach, yReach] = plane.equal ? [(xMost * w) / 2 / unit, (yMost * h) / 2 / unit] : [xMost, yMost];
    const x = d3.scaleLinear().domain([-xReach, xReach]).range([margin.left, margin.left + w]);
    const y = d3.scaleLinear().domain([-yReach, yReach]).range([margin.top + h, margin.top]);
    scales = { x, y };
    xAxis.attr('transform', `translate(0 ${margin.top + h})`)
      .call(d3.axisBottom(x).ticks(5).tickFormat(shown).tickSize(-h).tickSizeOuter(0).tickPadding(6));
    yAxis.attr('transform', `translate(${margin.left} 0)`)
      .call(d3.axisLeft(y).ticks(5).tickFormat(shown).tickSize(-w).tickSizeOuter(0).tickPadding(6));
    xName.attr('x', margin.left + w).attr('y', height - 6);
    yName.attr('x', -margin.top).attr('y', 12);
    if (circle) {
      circle.attr('cx', x(0)).attr('cy', y(0)).attr('rx', x(radius) - x(0)).attr('ry', y(0) - y(radius));
    }
    for (const { track, line } of marks) {
      line.attr('d', lineText(track.log[plane.x].map(x), track.log[plane.y].map(y), rowsOfTrack(track)));
    }
    place();
  };
  new ResizeObserver(redraw).observe(svg.node());
  bus.on(`rows.${plane.name}`, () => { setReach(); redraw(); });
  bus.on(`time.${plane.name}`, place);
  bus.on(`visibility.${plane.name}`, () => {
    for (const { track, layer } of marks) layer.style('display', track.visible ? null : 'none');
  });
}

function drawPhasePlanes() {
  const planes = PHASE_PLANES.filter((plane) => tracks.some((track) => track.log[plane.x] && track.log[plane.y]));
  if (!planes.length) return;
  const plots = section('phase-planes', 'Phase planes').append('div').attr('class', 'plots');
  for (const plane of planes) drawPhasePlane(plots, plane);
}
