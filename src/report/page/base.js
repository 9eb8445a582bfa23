// JavaScript code shared by all parts of a report page: data, tracks, the current time of the page,
// formatting of numbers.

const data = JSON.parse(document.getElementById('data').textContent);
const runs = data.runs || [];
const root = d3.select('#report');

/** Formats a number with four digits. Returns any other value as text, unchanged. */
function shown(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (value === true) return 'yes';
  if (value === false) return 'no';
  if (typeof value !== 'number') return String(value);
  const size = Math.abs(value);
  const format = size === 0 || Number.isInteger(value) && size < 1e6 ? 'd'
    : size >= 1e6 || size < 1e-4 ? '.3~e'
    : size >= 1000 ? '.1~f' : '.4~r';
  return d3.format(format)(value).replace(/-/g, '−');
}

/** Formats a number for summaries, with at most three digits and four decimals. */
function brief(value, unit) {
  if (typeof value !== 'number') return shown(value);
  const size = Math.abs(value);
  if (Number.isInteger(value) || size >= 1e6) return shown(value);
  // Lengths, angles and times have at most four decimals, since further digits are not accurate.
  if (size < 5e-5 && ['m', 'rad', 's'].includes(unit)) return '0.0000';
  if (size < 5e-5) return d3.format('.1~e')(value).replace(/-/g, '−');
  return d3.format(size >= 100 ? '.1~f' : size < 0.01 ? '.4~f' : '.3~r')(value).replace('-', '−');
}

/** Formats a length, rounded to centimeters or, below 10 cm, to millimeters. */
function meters(value) {
  return `${fixed(value, Math.abs(value) < 0.0995 ? 3 : 2)} m`;
}

/** Sets a label such as "Speed [m/s]", with the unit in a separate element. */
function withUnit(selection, label, unit) {
  selection.text(label);
  if (unit) selection.append('span').attr('class', 'unit').text(` [${unit}]`);
  return selection;
}

/** Adds a section with a title. */
function section(id, title) {
  const made = root.append('section').attr('id', id);
  if (title) made.append('h2').text(title);
  return made;
}

/**
 * All plants of all runs ("tracks"), each with a color. If possible, a plant has the same color as
 * in films.
 */
const tracks = runs.flatMap((run, r) => run.plants.map((plant) => ({
  run: r,
  plant: plant.name,
  label: runs.length > 1 ? `${run.name} · ${plant.name}` : plant.name,
  log: plant.log,
  newPlans: plant.new_plans || [],
  numbers: plant.numbers,
  events: plant.events || { rate_limit: [], known: [] },
  tyres: plant.tyres,
  end: plant.end,
  visible: true,
})));
(function assignColors() {
  const free = d3.range(8);
  const take = (color) => {
    const at = free.indexOf(color);
    return at < 0 ? undefined : free.splice(at, 1)[0];
  };
  for (const track of tracks) {
    if (track.plant === 'kinematic') track.color = take(0);
    else if (track.plant.startsWith('mujoco')) track.color = take(1);
  }
  tracks.forEach((track, i) => {
    track.id = i;
    if (track.color === undefined) track.color = free.length ? free.shift() : i % 8;
    track.css = `var(--track-${track.color})`;
  });
})();

const lastMoment = () => d3.max(tracks, (track) => track.log.t[track.log.t.length - 1]) || 0;
let duration = lastMoment();

/** Returns the position of a time between two rows of a log, clamped to the ends of the log. */
function placeAt(log, time) {
  const next = Math.min(Math.max(d3.bisectRight(log.t, time), 1), log.t.length - 1);
  if (next < 1) return { row: 0, next: 0, part: 0 };
  const row = next - 1;
  const part = (time - log.t[row]) / (log.t[next] - log.t[row]);
  return { row, next, part: Math.min(Math.max(part, 0), 1) };
}

/** Returns the time of a collision or roll-over; undefined if there was neither. */
function brokenAt({ end }) {
  return ['collided', 'rolled_over'].includes(end.status) ? end.t : undefined;
}

/** Interpolates linearly between rows. Beyond the ends, the result is the end value. */
function interpolated(xs, ys, x) {
  if (xs.length < 2) return ys[0];
  const next = Math.min(Math.max(d3.bisectRight(xs, x), 1), xs.length - 1);
  const part = (x - xs[next - 1]) / (xs[next] - xs[next - 1]);
  return ys[next - 1] + Math.min(Math.max(part, 0), 1) * (ys[next] - ys[next - 1]);
}

/** Returns the value of a quantity at a time; null after the end of the run. */
function valueAt(track, name, time) {
  const values = track.log[name];
  const end = track.log.t[track.log.t.length - 1];
  if (!values || time > end + 1e-9) return null;
  const { row, next, part } = placeAt(track.log, time);
  return values[row] + part * (values[next] - values[row]);
}

/** Returns the car's pose at a time. After the end of the run, the result is the last pose. */
function poseAt(track, time) {
  const { x, y, yaw } = track.log;
  const { row, next, part } = placeAt(track.log, time);
  const turn = Math.atan2(Math.sin(yaw[next] - yaw[row]), Math.cos(yaw[next] - yaw[row]));
  return {
    x: x[row] + part * (x[next] - x[row]),
    y: y[row] + part * (y[next] - y[row]),
    yaw: yaw[row] + part * turn,
  };
}

// The current time of the page, which map, charts and films show. Listeners are notified when the
// current time changes.
const bus = d3.dispatch('time', 'visibility', 'scheme', 'play', 'rows');
let now = 0;

function setTime(time, from) {
  now = Math.min(Math.max(time, 0), duration);
  bus.call('time', null, now, from);
}

/** Called by live.js when rows were added to the logs of a run in progress. */
function rowsAdded() {
  duration = lastMoment();
  bus.call('rows');
}

window.matchMedia('(prefers-color-scheme: dark)')
  .addEventListener('change', () => bus.call('scheme'));

/** Reads a color of the style sheet, for use on a canvas. */
function cssColor(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
