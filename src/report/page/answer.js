// Draws the first screen of a report. The first screen of a report shows how each run ended, and
// the distances of each car from its path and from the other cars. The first screen also states
// when the largest distance occurred, and the margins to the expectations.

// maximum number of listed plants; plants with the largest distance from the path come first
const MOST_ROWS = 4;

/** Returns a status of metrics.json as text, such as "rolled over". */
function statusText(status) {
  return status.replace(/_/g, ' ');
}

function endText({ end }) {
  if (end.t === undefined) return statusText(end.status);
  const after = ['arrived', 'stopped', 'time_limit', 'interrupted'].includes(end.status);
  return `${statusText(end.status)} ${after ? 'after' : 'at'} ${brief(end.t)} s`
    + (end.cause ? ` (${end.cause})` : '');
}

/** Finds the point where a track is furthest from its path: {size, side, s, t}. */
function furthestFromPath(track) {
  const size = valueOf(track.numbers, 'cross_track.max');
  if (size === null) return null;
  const t = valueOf(track.numbers, 'cross_track.max_t');
  const signed = valueAt(track, 'cross_track', t) || 0;
  return { size, t, s: valueOf(track.numbers, 'cross_track.max_s'), side: signed < 0 ? 'right' : 'left' };
}

/** Finds the point where two tracks are furthest apart at equal station. */
function furthestApart(pair) {
  if (!pair.curve) return null;
  const value = (name) => valueOf(pair.numbers, `position.${name}`);
  return { size: value('max'), s: value('max_s'), t: value('max_t') };
}

/**
 * The time that the page shows when it is opened: the first collision or roll-over or, in this
 * order, the time of the largest distance between cars, the time of the largest distance of a car
 * from its path, or the end of the first run that did not arrive.
 */
const keyMoment = (() => {
  const broken = d3.min(tracks, brokenAt);
  if (broken !== undefined) return broken;
  const largest = (list) => list.filter(Boolean).sort((a, b) => b.size - a.size)[0];
  const found = largest(pairs.map(furthestApart)) || largest(tracks.map(furthestFromPath));
  if (found) return found.t;
  const ended = tracks.find((track) => track.end.status !== 'arrived' && track.end.t !== undefined);
  return ended ? ended.end.t : 0;
})();

/**
 * Returns the friction patch under a car at a time; the last one in the world's list if there are
 * several.
 */
function patchUnder(track, time) {
  const { x, y } = poseAt(track, time);
  return runs[track.run].world.patches.filter((patch) => {
    const [dx, dy] = [x - patch.x, y - patch.y];
    const along = dx * Math.cos(patch.yaw) + dy * Math.sin(patch.yaw);
    const across = -dx * Math.sin(patch.yaw) + dy * Math.cos(patch.yaw);
    return Math.abs(along) <= patch.length / 2 && Math.abs(across) <= patch.width / 2;
  }).pop();
}

/** Returns remarks on what a car did during the three seconds before a moment. */
function remarks(track, moment) {
  const list = [];
  const before = track.log.t.filter((t) => t <= moment);
  const times = before.filter((t) => t >= moment - 3);
  const last = times.filter((t) => patchUnder(track, t)).pop();
  if (last !== undefined) {
    const patch = patchUnder(track, last);
    let first = last;
    for (const t of [...before].reverse()) {
      if (t <= last && patchUnder(track, t) !== patch) break;
      first = Math.min(first, t);
    }
    list.push(`was on friction ${shown(patch.friction)} from ${brief(first)} to ${brief(last)} s`);
  }
  const { car, world } = runs[track.run];
  const share = (t) => {
    const friction = (patchUnder(track, t) || world).friction;
    return Math.abs(valueAt(track, 'lateral_acceleration', t) || 0) / (friction * car.grip_acceleration);
  };
  // The kinematic plant has no tyres and may exceed the available grip, so no remark about grip is
  // made.
  const used = track.plant === 'kinematic' ? 0 : d3.max(times, share) || 0;
  if (used > 0.8) list.push(`uses ${used > 1 ? 'all' : `${Math.round(100 * used)} %`} of the tyres' lateral grip`);
  const asked = d3.max(times, (t) => Math.abs(valueAt(track, 'steering_command', t) - valueAt(track, 'steering', t))) || 0;
  if (asked > 0.02) list.push(`steers up to ${brief(asked)} rad less than commanded`);
  const slip = d3.max(times, (t) => Math.abs(valueAt(track, 'sideslip', t) || 0)) || 0;
  if (track.plant !== 'kinematic' && slip > 0.1) list.push(`slides at a sideslip angle of ${brief(slip)} rad`);
  return list;
}

/**
 * Draws a bar from zero to a value, with a mark at the limit. With the same `most`, several bars
 * share a scale.
 */
function drawBar(parent, { value, limit, most, css, good }) {
  const bar = parent.append('span').attr('class', `bar ${good === false ? 'bad' : ''}`).attr('aria-hidden', 'true');
  const low = Math.min(0, 1.15 * value, 1.15 * (limit || 0));
  const place = (x) => Math.min(100, Math.max(0, (100 * (x - low)) / (most - low)));
  const [from, to] = [0, value].map(place).sort(d3.ascending);
  bar.append('span').attr('class', 'fill').style('left', `${from}%`).style('width', `${to - from}%`).style('background', css || null);
  if (limit !== undefined) bar.append('span').attr('class', 'limit').style('left', `${place(limit)}%`);
}

/**
 * Draws the summary: first collisions and roll-overs, then the car furthest from its path, with
 * place and distance, then the other cars.
 */
function drawSentence(parent) {
  // distance from the path up to which a car counts as on the path [m]; half the width of a tyre
  const NEAR = 0.1;
  const found = tracks.map((track) => ({ track, far: furthestFromPath(track) })).filter(({ far }) => far)
    .sort((a, b) => b.far.size - a.far.size);
  const broken = tracks.filter((track) => brokenAt(track) !== undefined).sort((a, b) => brokenAt(a) - brokenAt(b));
  if (!found.length && !broken.length) return;
  const line = parent.append('p').attr('class', 'sentence');
  const name = (track) => {
    const whole = line.append('span').attr('class', 'whole');
    whole.append('span').attr('class', 'dot').style('color', track.css);
    whole.append('strong').text(` ${track.label}`);
  };
  const say = (text) => line.append('span').text(text);
  const place = (text, t) => {
    const whole = line.append('span').attr('class', 'whole');
    whole.append('button').attr('type', 'button').attr('class', 'place').attr('title', 'Show this moment').text(text).on('click', () => setTime(t));
    whole.append('span').text('.');
    say(' ');
  };
  for (const track of broken) {
    name(track);
    line.append('strong').text(track.end.status === 'collided' ? ' collides' : ' rolls over');
    say(' ');
    place(`at ${fixed(track.end.t, 2)} s`, track.end.t);
  }
  if (!found.length) return;
  const [{ track, far }, ...others] = found;
  // If a car collided or rolled over, only distances before that event are shown.
  if (broken.length) say('Before: ');
  else if (far.size < NEAR) say(tracks.length > 1 ? 'No car leaves the path: ' : 'The car keeps to the path: ');
  name(track);
  say(far.size < NEAR ? `${tracks.length > 1 ? ', the furthest,' : ''} is ` : tracks.length > 1 ? ' strays furthest from the path: ' : ' strays from the path: ');
  line.append('strong').attr('class', 'whole').text(`${meters(far.size)} to the ${far.side}`);
  say(', ');
  place(`${fixed(far.s, 1)} m along it, at ${fixed(far.t, 1)} s`, far.t);
  if (others.length === 1) name(others[0].track);
  if (others.length) say(`${others.length > 1 ? 'The others stay' : ' stays'} within ${meters(others[0].far.size)} of it.`);
}

/** Draws the main quantities of a maneuver's standard, each with its limit. */
function drawManeuverRows(parent) {
  const rows = rowsOf(tracks.map((track) => track.numbers))
    .filter((row) => row.path.startsWith('maneuver.') && row.path !== 'maneuver.passed' && (row.limit || row.headline))
    // If the standard of the maneuver limits any quantity, quantities without a limit are omitted.
    .filter((row, _, all) => row.limit || !all.some((other) => other.limit));
  if (!rows.length) return;
  const list = parent.append('ul').attr('class', 'rows');
  for (const row of rows) {
    for (const track of tracks) {
      const value = valueOf(track.numbers, row.path);
      if (typeof value !== 'number') continue;
      const line = list.append('li');
      const head = line.append('span').attr('class', 'who');
      head.append('span').attr('class', 'dot').style('color', track.css);
      head.append('span').attr('class', 'name').text(upperFirst(row.label.replace(/^Maneuver: /, '')));
      const unit = row.unit ? ` ${row.unit}` : '';
      const met = row.limit ? keeps(value, row.limit) : null;
      line.append('span').attr('class', `size ${met === false ? 'bad' : ''}`).text(`${brief(value)}${unit}${met === null ? '' : met ? ' ✓' : ' ✗'}`);
      const about = [tracks.length > 1 && track.label, limitText(row.limit, row.unit)].filter(Boolean).join(', ');
      if (about) line.append('span').attr('class', 'what').text(about);
      if (row.limit) {
        const most = 1.15 * Math.max(Math.abs(value), Math.abs(row.limit.bound)) || 1;
        drawBar(line, { value, limit: row.limit.bound, most, good: met });
      }
    }
  }
}

function drawAnswerRows(parent) {
  const own = tracks.map((track) => ({ track, found: furthestFromPath(track) }))
    .sort((a, b) => (b.found ? b.found.size : -1) - (a.found ? a.found.size : -1)).slice(0, MOST_ROWS);
  const apart = pairs.map((pair) => ({ pair, found: furthestApart(pair) })).filter(({ found }) => found);
  const most = d3.max([...own, ...apart], ({ found }) => found && found.size) || 1;
  const place = ({ s, t }) => `at ${fixed(s, 1)} m, ${fixed(t, 1)} s`;
  const row = (name, sign, text, found, more) => {
    const line = parent.append('li');
    const head = line.append('span').attr('class', 'who');
    sign(head);
    head.append('span').attr('class', 'name').text(name);
    if (found) line.append('span').attr('class', 'size').text(`${meters(found.size)} ${more.side}`);
    line.append('span').attr('class', 'what').text(text);
    if (!found) return;
    line.append('button').attr('type', 'button').attr('class', 'place').attr('title', 'Show this moment')
      .text(place(found)).on('click', () => setTime(found.t));
    drawBar(line, { value: found.size, most, css: more.css });
  };
  for (const { track, found } of own) {
    row(track.label, (at) => at.append('span').attr('class', 'dot').style('color', track.css),
      endText(track), found,
      { css: track.css, side: found && found.side });
  }
  if (tracks.length > own.length) {
    parent.append('li').append('span').attr('class', 'what').text(`${tracks.length - own.length} more, nearer to their paths, are in the table below`);
  }
  for (const { pair, found } of apart.sort((a, b) => b.found.size - a.found.size).slice(0, 4)) {
    row(pair.label, (at) => signOfPair(at, pair), 'at equal station', found, { css: 'var(--muted)', side: 'apart' });
  }
}

/**
 * Returns the result of a check as text, such as "0.151 ≤ 0.155 rad/s", "rolled over" or "no, not
 * yes".
 */
function measuredText({ relation, bound, found, unit, met }) {
  const told = (value) => statusText(brief(value, unit));
  if (relation === 'equals') return met ? told(found) : `${told(found)}, not ${told(bound)}`;
  return `${told(found)} ${relation === 'at_most' ? '≤' : '≥'} ${told(bound)}${unit ? ` ${unit}` : ''}`;
}

/**
 * Returns how much of a check's bound is used. The value is at most 1 if the check is met, and
 * above 1 otherwise.
 */
function shareOfBound({ relation, bound, found }) {
  if (typeof bound !== 'number' || typeof found !== 'number' || relation === 'equals') return null;
  if (relation === 'at_most') return bound > 0 ? found / bound : null;
  return found > 0 ? bound / found : null;
}

function drawExpectationBars(parent) {
  const MOST = 6;
  const all = runs.flatMap((run) => run.expectations.map((check) => ({ run, check, share: shareOfBound(check) })));
  if (!all.length) return;
  const panel = parent.append('div').attr('class', 'panel limits');
  panel.append('h2').text('Expectations');
  // Failed checks come first, followed by the passed checks that are nearest to their limits.
  const order = [...all].sort((a, b) => a.check.met - b.check.met || (b.share || 0) - (a.share || 0));
  const list = panel.append('ul');
  for (const { run, check, share } of order.slice(0, MOST)) {
    const line = list.append('li').attr('class', check.met ? 'good' : 'bad');
    const name = line.append('span').attr('class', 'what');
    name.append('span').attr('class', 'mark').text(check.met ? '✓' : '✗');
    name.append('span').text(`${check.what}, ${runs.length > 1 ? `${run.name} · ` : ''}${check.of}`);
    line.append('span').attr('class', 'size').text(measuredText(check));
    if (share !== null) {
      const most = 1.15 * Math.max(Math.abs(check.found), Math.abs(check.bound));
      drawBar(line, { value: check.found, limit: check.bound, most, good: check.met });
    }
  }
  const left = all.length - MOST;
  if (left > 0) {
    panel.append('button').attr('type', 'button').attr('class', 'place')
      .on('click', () => document.getElementById('expectations').scrollIntoView())
      .text(`${left} more ${left > 1 ? 'are' : 'is'} ${order.slice(MOST).every(({ check }) => check.met) ? 'met' : 'below'}`);
  }
}

/** Draws the first screen of the page. */
function drawAnswer() {
  if (!tracks.length) return;
  const grid = section('answer').append('div').attr('class', 'answer');
  const panel = grid.append('div').attr('class', 'panel happened');
  panel.append('h2').text('What happened');
  drawManeuverRows(panel);
  drawSentence(panel);
  drawAnswerRows(panel.append('ul').attr('class', 'rows'));
  const found = tracks.map((track) => ({ track, list: remarks(track, keyMoment) })).filter(({ list }) => list.length).slice(0, MOST_ROWS);
  if (found.length) {
    const facts = panel.append('p').attr('class', 'remarks');
    facts.append('span').text(`Up to ${brief(keyMoment)} s: `);
    facts.append('span').text(found.map(({ track, list }) => `${track.label} ${list.join(', ')}`).join('; '));
  }
  drawReplay(grid);
  drawExpectationBars(grid);
}
