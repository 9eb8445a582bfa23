// Shows the result of a path check: whether a car can follow the path at a given speed, where this
// is impossible, and how fast the car could drive.

const faultNames = {
  reversal: 'turns back on itself',
  heading_jump: 'heading jumps',
  steering_angle: 'steering angle',
  steering_rate: 'steering rate',
  friction: 'friction',
  roll_over: 'roll-over',
  top_speed: 'top speed',
};

function drawPathCheck(check) {
  drawPathCheckHead(check);
  if (check.faults.length) drawFaults(section('faults', 'Where it cannot be driven'), check);
  const parts = section('path', 'Path');
  const grid = parts.append('div').attr('class', 'drive');
  drawPathCheckMap(grid.append('div').attr('class', 'scene').append('div').attr('class', 'panel map-panel'), check);
  if (check.demand.s.length) drawPathCheckCharts(grid.append('div').attr('class', 'all-charts'), check);
}

function drawPathCheckHead(check) {
  const header = root.append('header');
  const heading = header.append('div').attr('class', 'heading');
  heading.append('h1').text(check.name);
  badge(heading, check.drivable, `${check.drivable ? 'drivable' : 'not drivable'} at ${brief(check.speed_mps)} m/s`).attr('id', 'verdict');
  const most = check.max_speed_mps;
  facts(header, [
    `vehicle ${check.vehicle}`,
    check.length_m > 0 && `${brief(check.length_m)} m`,
    `${check.points} points`,
    check.fit !== 'none' && check.fit,
    most === null ? 'no limit of speed'
      : most > 0 ? `drivable up to ${brief(most)} m/s (${faultNames[check.max_speed_limit]} at s = ${brief(check.max_speed_s_m)} m)`
        : `drivable at no speed (${faultNames[check.max_speed_limit]} at s = ${brief(check.max_speed_s_m)} m)`,
    `friction ${brief(check.friction)}`,
    ...check.notes.split('\n'),
    `Trackbed ${check.version}`,
  ]);
}

function drawFaults(parent, { faults }) {
  const most = 200;
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Reason');
  for (const name of ['s [m]', 'x [m]', 'y [m]', 'Over [m]', 'Asked', 'Limit']) head.append('th').text(name);
  head.append('th').attr('class', 'text').text('Unit');
  const body = table.append('tbody');
  for (const fault of faults.slice(0, most)) {
    const line = body.append('tr').attr('data-fault', fault.kind);
    line.append('td').attr('class', 'text').text(faultNames[fault.kind]);
    for (const value of [fault.s_m, fault.x_m, fault.y_m, fault.to_s_m - fault.from_s_m, fault.asked, fault.limit]) {
      line.append('td').text(brief(value));
    }
    line.append('td').attr('class', 'text').text(fault.unit.replace('^2', '²'));
  }
  if (faults.length > most) parent.append('p').attr('class', 'hint').text(`and ${faults.length - most} more`);
}

/** Whether a station lies in a range with a fault. */
function faultAt(faults, s) {
  return faults.some((fault) => s >= fault.from_s_m - 0.05 && s <= fault.to_s_m + 0.05);
}

function drawPathCheckMap(panel, { demand, given, faults }) {
  const width = 720;
  const height = 480;
  const margin = 36;
  const xs = [...given.x, ...demand.x];
  const ys = [...given.y, ...demand.y];
  const middle = [(d3.min(xs) + d3.max(xs)) / 2, (d3.min(ys) + d3.max(ys)) / 2];
  const scale = Math.min((width - 2 * margin) / Math.max(d3.max(xs) - d3.min(xs), 1), (height - 2 * margin) / Math.max(d3.max(ys) - d3.min(ys), 1));
  const x = (value) => width / 2 + scale * (value - middle[0]);
  const y = (value) => height / 2 - scale * (value - middle[1]);
  const svg = panel.append('svg').attr('class', 'path-check').attr('viewBox', `0 0 ${width} ${height}`).attr('role', 'img')
    .attr('aria-label', `The path from above, ${faults.length} places where it cannot be driven`);
  const line = d3.line().x(([a]) => x(a)).y(([, b]) => y(b));
  const pairsOf = (of) => of.x.map((value, i) => [value, of.y[i]]);
  svg.append('path').attr('class', 'given').attr('d', line(pairsOf(given)));
  if (demand.s.length) svg.append('path').attr('class', 'fitted').attr('d', line(pairsOf(demand)));
  const bad = d3.line().x(([a]) => x(a)).y(([, b]) => y(b)).defined(([, , s]) => faultAt(faults, s));
  svg.append('path').attr('class', 'fault').attr('d', bad(demand.s.map((s, i) => [demand.x[i], demand.y[i], s])));
  for (const fault of faults) {
    svg.append('circle').attr('class', 'fault').attr('cx', x(fault.x_m)).attr('cy', y(fault.y_m)).attr('r', 4)
      .append('title').text(fault.text);
  }
  svg.append('circle').attr('class', 'start').attr('cx', x(given.x[0])).attr('cy', y(given.y[0])).attr('r', 9).append('title').text('start');
  // Draws the map's scale bar, whose length is a round number.
  const bar = d3.ticks(0, 160 / scale, 2).filter((value) => value > 0)[0];
  svg.append('path').attr('class', 'bar').attr('d', `M${margin / 2} ${height - 14}h${bar * scale}`);
  svg.append('text').attr('x', margin / 2).attr('y', height - 20).text(`${shown(bar)} m`);
  if (demand.s.length) {
    const marker = svg.append('circle').attr('class', 'here').attr('r', 5);
    bus.on('time.path_check_map', (s) => {
      marker.attr('cx', x(interpolated(demand.s, demand.x, s))).attr('cy', y(interpolated(demand.s, demand.y, s)));
    });
  }
  panel.append('p').attr('class', 'hint map-hint').text('Ring: start. Red: cannot be driven at the speed. Thin: the points of the file.');
}

function drawPathCheckCharts(list, check) {
  const { demand } = check;
  duration = demand.s[demand.s.length - 1];
  const chart = (name, title, unit, lines, limits, note) => ({
    name, title, unit, note,
    limits: limits.filter((limit) => limit !== null),
    lines: lines.map(([label, color, values, pattern]) => ({ label, color, values, pattern, tracks: [], width: 1.5 })),
    readouts: lines.map(([label, color, values]) => ({
      label,
      tracks: [],
      sign: (node) => node.append('span').attr('class', 'dot').style('color', `var(--track-${color})`),
      text: (s) => fixed(interpolated(demand.s, values, s), 3),
    })),
  });
  const wanted = demand.s.map(() => check.speed_mps);
  // The speed axis is limited, because the possible speed on a straight is unlimited.
  const most = 4 * check.speed_mps;
  const possible = demand.speed.map((speed) => Math.min(speed, most));
  const limits = [['friction', check.friction_limit_mps2], ['roll-over', check.rollover_limit_mps2]]
    .filter(([, limit]) => limit !== null).map(([name, limit]) => `${name} ${brief(limit)} m/s²`);
  drawCharts(list, 'path_check', { values: demand.s, unit: 'm', at: (s) => s, timeOf: (s) => s }, [
    chart('curvature', 'Curvature', '1/m', [['curvature', 0, demand.curvature]], []),
    chart('curvature_rate', 'Curvature rate', '1/m²', [['curvature rate', 0, demand.curvature_rate]], []),
    chart('steering', 'Steering angle', 'rad', [['steering angle', 0, demand.steering]], [check.steering_limit_rad]),
    chart('steering_rate', `Steering rate at ${brief(check.speed_mps)} m/s`, 'rad/s', [['steering rate', 0, demand.steering_rate]], [check.steering_rate_limit_radps]),
    chart('lateral_acceleration', `Lateral acceleration at ${brief(check.speed_mps)} m/s`, 'm/s²', [['lateral acceleration', 0, demand.lateral_acceleration]], [check.friction_limit_mps2, check.rollover_limit_mps2],
      limits.length && `limits by ${limits.join(', by ')}`),
    chart('speed', 'Possible speed', 'm/s', [['possible speed', 0, possible], ['speed', 1, wanted, [4, 3]]], [], `dashed: the speed that is checked; cut off at ${brief(most)} m/s`),
  ]);
  setTime(0);
}
