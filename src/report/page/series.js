// Draws the charts of the logged quantities over time.

const QUANTITIES = [
  { name: 'cross_track', title: 'Cross-track error', unit: 'm', digits: 4, note: 'positive: left of the path' },
  { name: 'heading_error', title: 'Heading error', unit: 'rad', digits: 4, note: 'positive: turned to the left' },
  { name: 'steering', title: 'Steering angle', unit: 'rad', digits: 4, asked: 'steering_command', note: 'dashed: commanded' },
  { name: 'speed', title: 'Speed', unit: 'm/s', digits: 3 },
  { name: 'yaw_rate', title: 'Yaw rate', unit: 'rad/s', digits: 4 },
  { name: 'lateral_acceleration', title: 'Lateral acceleration', unit: 'm/s²', digits: 3 },
  { name: 'clearance', title: 'Clearance from obstacles', unit: 'm', digits: 3 },
  { name: 'hitch_angle', title: 'Hitch angle', unit: 'rad', digits: 4, note: 'positive: trailer turned to the left' },
];

/**
 * Returns the times of all logs together, and a function that gives each track's values at these
 * times. A value is null if the track has no row at that time.
 */
function commonTimes() {
  const times = Array.from(new Set(tracks.flatMap((track) => track.log.t))).sort(d3.ascending);
  const rows = tracks.map((track) => {
    const row = new Map(track.log.t.map((t, i) => [t, i]));
    return times.map((t) => row.get(t));
  });
  const spread = (track, name) => rows[track.id].map((row) => (row === undefined ? null : track.log[name][row]));
  return { times, spread };
}

/**
 * Returns the limits of a quantity, from the expectations and from the car. A signed quantity has a
 * positive and a negative limit.
 */
function limitsOf(name) {
  const metric = {
    cross_track: 'cross_track.max',
    heading_error: 'heading_error.max',
    lateral_acceleration: 'lateral_acceleration_max',
    clearance: 'clearance_min',
    hitch_angle: 'hitch_angle.max',
  }[name];
  const limits = runs.flatMap((run) => run.expectations)
    .filter((check) => check.metric === metric && typeof check.bound === 'number').map((check) => check.bound);
  // The car's steering limit is drawn only if it is less than twice the largest steering angle of
  // the run.
  const steering = d3.max(tracks, (track) => d3.max(track.log.steering, Math.abs));
  if (name === 'steering') limits.push(...runs.map((run) => run.car.steering_limit).filter((limit) => limit > 0 && limit < 2 * steering));
  return Array.from(new Set(name === 'clearance' ? limits : limits.flatMap((limit) => [limit, -limit])));
}

function drawSeries(parent) {
  const list = parent.append('div').attr('class', 'series');
  const { times, spread } = commonTimes();
  const axis = { values: times, unit: 's', at: (time) => time, timeOf: (time) => time };
  const line = (track, name, more) => ({
    label: track.label, color: track.color, tracks: [track], quantity: name, values: spread(track, name), until: brokenAt(track), ...more,
  });
  const charts = QUANTITIES.filter((q) => tracks.some((track) => track.log[q.name])).map((quantity) => {
    const own = tracks.filter((track) => track.log[quantity.name]);
    const told = (track, name, time) => fixed(valueAt(track, name, time), quantity.digits);
    return {
      ...quantity,
      limits: limitsOf(quantity.name),
      // Commanded values are drawn first, so that the measured values are on top.
      lines: [
        ...(quantity.asked ? own.map((track) => line(track, quantity.asked, { pattern: [5, 4], width: 1.2 })) : []),
        ...own.map((track) => line(track, quantity.name, { width: 1.6 })),
      ],
      readouts: own.map((track) => ({
        label: track.label,
        tracks: [track],
        sign: (parent) => parent.append('span').attr('class', 'dot').style('color', track.css),
        text: (time) => told(track, quantity.name, time)
          + (quantity.asked ? ` (${told(track, quantity.asked, time)})` : ''),
      })),
    };
  });
  bus.on('rows.series', () => {
    const { times: grown, spread: anew } = commonTimes();
    axis.values = grown;
    for (const { lines } of charts) {
      for (const one of lines) one.values = anew(one.tracks[0], one.quantity);
    }
  });
  // the charts are drawn after the listener for new rows is registered
  drawCharts(list, 'series', axis, charts);
}
