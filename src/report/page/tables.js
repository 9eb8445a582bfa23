// Draws the texts and tables of a report on runs.
// 1. The function drawHead shows the verdict and the facts of each run.
// 2. The function drawHeadline shows the most important metrics as cards or, for more than two
//    tracks, as a table.
// 3. The function drawNumbers shows all metrics, with one row for each path and one column for each
//    track.
// 4. The function drawExpectations shows the checks. The function drawScenarios shows the resolved
//    scenarios with their differences.

function badge(parent, good, text) {
  return parent.append('span').attr('class', `badge ${good ? 'good' : 'bad'}`).text(text);
}

function verdictOf(run) {
  if (!run.complete) return { good: false, text: 'interrupted' };
  if (run.verdict.passed === null) return { good: true, text: 'not judged' };
  if (!run.verdict.passed) return { good: false, text: 'failed' };
  // A run that did not reach its goal can still pass, if the scenario expects this.
  const ends = Array.from(new Set(run.plants.map(({ end }) => end.status))).filter((status) => status !== 'arrived');
  return { good: true, text: ends.length ? `as expected: ${ends.map(statusText).join(', ')}` : 'passed' };
}

function facts(parent, list) {
  const facts = parent.append('ul').attr('class', 'facts');
  for (const fact of list.filter(Boolean)) facts.append('li').text(fact);
}

function planFact(plan) {
  if (!plan) return 'no plan';
  const length = plan.length_m === undefined ? '' : `, ${shown(plan.length_m)} m`;
  return `plan: ${plan.method}${length}${plan.status === 'ok' ? '' : ` (${plan.status})`}`;
}

function drawHead() {
  const header = root.append('header');
  const heading = header.append('div').attr('class', 'heading');
  heading.append('h1').text(runs.length === 1 ? runs[0].scenario : `${runs.length} runs compared`);
  if (runs.length === 1) {
    const { good, text } = verdictOf(runs[0]);
    badge(heading, good, text).attr('id', 'verdict');
  }
  // A comparison that has neither failures nor additional notes is shown only as a badge.
  const verdicts = (data.comparison || {}).verdicts || [];
  const isBrief = ({ failures, notes }) => runs.length === 1 && !failures.length && notes.every((note) => runs[0].verdict.notes.includes(note));
  for (const { passed } of verdicts.filter(isBrief)) {
    if (passed === null) heading.append('span').attr('class', 'badge plain').text('compared without tolerances');
    else badge(heading, passed, `comparison ${passed ? 'passed' : 'failed'}`);
  }
  const one = runs[0];
  facts(header, [
    runs.length === 1 && runs[0].name !== runs[0].scenario && `folder ${one.name}`,
    runs.length === 1 && planFact(one.plan),
    runs.length === 1 && `car: ${one.car.name}`,
    runs.length === 1 && `seed ${one.seed}`,
    `Trackbed ${one.versions.trackbed}`, one.versions.physics, one.versions.optimizer,
  ]);
  for (const { run, passed, failures, notes } of verdicts.filter((verdict) => !isBrief(verdict))) {
    const verdict = header.append('div').attr('class', `verdict comparison ${passed === false ? 'bad' : ''}`);
    const line = verdict.append('div').attr('class', 'heading');
    line.append('span').text(run === undefined ? 'Comparison' : `Comparison in ${runs[run].name}`);
    if (passed === null) line.append('span').attr('class', 'badge plain').text('no tolerances');
    else badge(line, passed, passed ? 'passed' : 'failed');
    drawReasons(verdict, failures, notes);
  }
  const { left_out: leftOut = [] } = data.comparison || {};
  if (leftOut.length) drawReasons(header.append('div').attr('class', 'verdict'), [], leftOut);
  for (const run of runs) {
    const { failures, notes } = run.verdict;
    if (runs.length === 1 && !failures.length && !notes.length) continue;
    const { good, text } = verdictOf(run);
    const verdict = header.append('div').attr('class', `verdict ${good ? '' : 'bad'}`);
    if (runs.length > 1) {
      const line = verdict.append('div').attr('class', 'heading');
      line.append('span').text(run.name);
      badge(line, good, text);
      facts(verdict, [run.scenario !== run.name && `scenario ${run.scenario}`, planFact(run.plan), `car: ${run.car.name}`, `seed ${run.seed}`]);
    }
    drawReasons(verdict, failures, notes);
  }
}

function drawReasons(parent, failures, notes) {
  if (!failures.length && !notes.length) return;
  const list = parent.append('ul');
  const written = (text) => text.replace(/\^2/g, '²');
  for (const failure of failures) list.append('li').text(written(failure));
  for (const note of notes) list.append('li').attr('class', 'note').text(written(note));
}

/** Merges the rows of several lists of numbers, in order. In the result, each path occurs once. */
function rowsOf(lists) {
  const rows = new Map();
  for (const list of lists) {
    let before = null;
    for (const { path, label, unit, headline, limit } of list) {
      if (!rows.has(path)) rows.set(path, { path, label, unit, headline, limit, before });
      before = path;
    }
  }
  // A row that occurs only in a later list is placed after its predecessor in that list.
  const order = [];
  for (const row of rows.values()) {
    const at = order.findIndex((other) => other.path === row.before);
    if (row.before === null) order.unshift(row);
    else order.splice(at + 1, 0, row);
  }
  return order;
}

function valueOf(list, path) {
  const found = list.find((number) => number.path === path);
  return found ? found.value : null;
}

function upperFirst(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Whether a value meets a limit of a standard, given as {relation, bound}. */
function keeps(value, { relation, bound }) {
  return relation === 'at_most' ? value <= bound : value >= bound;
}

/** Returns a limit of a standard as text, such as "at most 0.35 to pass". */
function limitText(limit, unit) {
  return limit ? `${limit.relation === 'at_most' ? 'at most' : 'at least'} ${brief(limit.bound)}${unit ? ` ${unit}` : ''} to pass` : '';
}

/** Draws the metrics of a standard maneuver, with units and limits. */
function drawManeuver() {
  const own = rowsOf(tracks.map((track) => track.numbers)).filter((row) => row.path.startsWith('maneuver.')
    && (row.unit || row.headline) && !['maneuver.begin', 'maneuver.end'].includes(row.path));
  if (!own.length) return;
  const methods = new Set(tracks.map((track) => valueOf(track.numbers, 'maneuver.method')).filter(Boolean));
  const made = section('maneuver', `Maneuver: ${statusText(Array.from(methods).join(', '))}`);
  const spans = tracks.map((track) => ['begin', 'end'].map((name) => brief(valueOf(track.numbers, `maneuver.${name}`))).join(' s to '));
  const isSame = new Set(spans).size === 1;
  const evaluated = isSame ? spans.slice(0, 1) : spans.map((span, i) => `${span} s (${tracks[i].label})`);
  made.append('p').attr('class', 'hint').text(`Evaluated from ${evaluated.join(', ')}${isSame ? ' s' : ''}. All times on this page count from the start of the run, its run-up included.`);
  if (tracks.length > 2) drawHeadlineTable(made, own);
  else drawCards(made, own.map((row) => ({ ...row, label: upperFirst(row.label.replace(/^Maneuver: /, '')) })));
}

/**
 * Draws the most important metrics, each on a card or, with more than two tracks, in a table with a
 * row per track.
 */
function drawHeadline() {
  if (!tracks.length) return;
  const all = rowsOf(tracks.map((track) => track.numbers)).filter((row) => row.headline);
  // The metrics of a maneuver are shown in a separate section.
  const rows = all.filter((row) => !row.path.startsWith('maneuver.'));
  const made = section('headline');
  if (tracks.length > 2) {
    drawHeadlineTable(made, rows);
    return;
  }
  if (rows.length < all.length) made.append('h3').text('Whole run');
  drawCards(made, rows);
}

/**
 * Returns the expected bound of a metric as text, such as "at most 0.5"; null unless all runs
 * expect the same bound.
 */
function askedOf(path) {
  const asked = new Set(runs.flatMap((run) => run.expectations).filter((check) => check.metric === path
    && check.relation !== 'equals').map((check) => check.asked));
  return asked.size === 1 ? Array.from(asked)[0] : null;
}

function drawHeadlineTable(parent, rows) {
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Plant');
  for (const row of rows) withUnit(head.append('th').attr('class', 'brief'), row.label, row.unit);
  const body = table.append('tbody');
  for (const track of tracks) {
    const line = body.append('tr').attr('data-track', track.label);
    const name = line.append('th').attr('scope', 'row');
    name.append('span').attr('class', 'dot').style('color', track.css);
    name.append('span').text(track.label);
    for (const row of rows) line.append('td').text(brief(valueOf(track.numbers, row.path)));
  }
}

function drawCards(parent, rows) {
  const cards = parent.append('div').attr('class', 'cards');
  for (const row of rows) {
    const card = cards.append('div').attr('class', 'card panel').attr('data-path', row.path);
    card.append('p').attr('class', 'label').text(row.label);
    for (const track of tracks) {
      const value = card.append('p').attr('class', 'value');
      value.append('span').attr('class', 'dot').style('color', track.css);
      value.append('span').attr('class', 'of').attr('title', track.label).text(track.label);
      const number = value.append('span').attr('class', 'number').text(brief(valueOf(track.numbers, row.path), row.unit));
      if (row.unit) number.append('span').attr('class', 'unit').text(` ${row.unit}`);
    }
    const values = tracks.map((track) => valueOf(track.numbers, row.path));
    if (values.length === 2 && row.unit && values.every((value) => typeof value === 'number')) {
      const apart = values[1] - values[0];
      const line = card.append('p').attr('class', 'value apart');
      line.append('span').attr('class', 'of').text('difference');
      line.append('span').attr('class', 'number').text(`${apart > 5e-5 ? '+' : ''}${brief(apart, row.unit)}`)
        .append('span').attr('class', 'unit').text(` ${row.unit}`);
    }
    const asked = askedOf(row.path);
    if (row.limit) {
      const kept = values.filter((value) => typeof value === 'number').every((value) => keeps(value, row.limit));
      card.append('p').attr('class', `asked ${kept ? 'good' : 'bad'}`).text(`${kept ? '✓' : '✗'} ${limitText(row.limit, row.unit)}`);
    }
    if (asked) card.append('p').attr('class', 'asked').text(`expected ${asked}${row.unit ? ` ${row.unit}` : ''}`);
  }
}

function drawLegend(parent) {
  const legend = parent.append('div').attr('class', 'legend');
  for (const track of tracks) {
    const button = legend.append('button').attr('type', 'button').attr('aria-pressed', 'true')
      .attr('data-track', track.label).attr('title', 'Show or hide');
    button.append('span').attr('class', 'dot').style('color', track.css);
    button.append('span').text(track.label);
    button.on('click', () => {
      track.visible = !track.visible;
      button.attr('aria-pressed', String(track.visible));
      bus.call('visibility');
    });
  }
  const sign = (name, draw) => {
    const entry = legend.append('span').attr('class', 'sign');
    draw(entry.append('svg').attr('width', 26).attr('height', 12).append('g').attr('class', 'world'));
    entry.append('span').text(name);
    return entry;
  };
  if (runs.some((run) => run.plan && run.plan.line)) {
    sign('plan', (svg) => svg.append('path').attr('class', 'plan').attr('d', 'M0 6h26'));
  }
  const replans = () => tracks.some((track) => track.newPlans.length);
  if (replans() || data.live) {
    const entry = sign('replan', (svg) => svg.append('path').attr('class', 'new-plan').attr('d', 'M0 6h26'));
    const show = () => entry.style('display', replans() ? null : 'none');
    show();
    bus.on('rows.legend', show);
  }
  if (runs.some((run) => run.world.walls)) {
    sign('map', (svg) => svg.append('path').attr('class', 'walls').attr('d', 'M4 1h18v10h-18z'));
  }
  if (runs.some((run) => run.world.obstacles.length)) {
    sign('obstacle', (svg) => svg.append('g').attr('class', 'obstacle').append('rect')
      .attr('x', 4).attr('y', 1).attr('width', 18).attr('height', 10));
  }
  if (runs.some((run) => run.plan && run.plan.cones.length)) {
    sign('cone', (svg) => svg.append('path').attr('class', 'cone').attr('d', 'M13 6h0'));
  }
  const shade = shadeOfMap();
  if (shade && shade.most > 0) {
    const entry = legend.append('span').attr('class', 'sign');
    entry.append('span').attr('class', 'scale');
    entry.append('span').text(`${shade.name}, 0 to ${brief(shade.most)} m`);
  }
  if (runs.some((run) => run.world.patches.length)) {
    sign('friction patch', (svg) => svg.append('rect').attr('class', 'patch').attr('width', 26).attr('height', 12));
  }
}

/** Draws a table of metrics, with one row per metric and one column per list. */
function drawNumbers(parent, columns) {
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('');
  for (const column of columns) {
    const cell = head.append('th');
    if (column.css) cell.append('span').attr('class', 'dot').style('color', column.css);
    cell.append('span').text(column.label);
  }
  const body = table.append('tbody');
  for (const row of rowsOf(columns.map((column) => column.numbers))) {
    const line = body.append('tr').attr('class', row.headline ? 'headline' : null).attr('data-path', row.path);
    withUnit(line.append('th').attr('scope', 'row').attr('title', row.path), row.label, row.unit);
    for (const column of columns) line.append('td').text(shown(valueOf(column.numbers, row.path)));
  }
}

function drawExpectations() {
  if (!runs.some((run) => run.expectations.length)) return;
  const table = section('expectations', 'Expectations').append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  const names = [...(runs.length > 1 ? ['Run'] : []), 'Plant', 'Metric'];
  for (const name of names) head.append('th').attr('class', 'text').text(name);
  for (const name of ['Expected', 'Measured', 'Met']) head.append('th').text(name);
  const body = table.append('tbody');
  for (const run of runs) {
    for (const entry of run.expectations) {
      const line = body.append('tr');
      if (runs.length > 1) line.append('td').attr('class', 'text').text(run.name);
      line.append('td').attr('class', 'text').text(entry.of);
      withUnit(line.append('td').attr('class', 'text'), entry.what, entry.unit);
      line.append('td').text(entry.asked);
      line.append('td').text(shown(entry.found));
      line.append('td').attr('class', entry.met ? 'good' : 'bad').text(entry.met ? '✓ yes' : '✗ no');
    }
  }
}

/**
 * Draws the resolved scenarios of the runs. Lines that are not in all scenarios are highlighted.
 */
function drawScenarios() {
  const lines = runs.map((run) => run.resolved.replace(/\n$/, '').split('\n'));
  const common = new Set(lines[0].filter((line) => lines.every((other) => other.includes(line))));
  const made = section('scenario', runs.length > 1 ? 'Resolved scenarios' : 'Resolved scenario');
  runs.forEach((run, i) => {
    const details = made.append('details').attr('class', 'panel');
    const summary = details.append('summary').text(run.name);
    if (runs.length > 1) summary.append('span').attr('class', 'hint').text('  lines that differ between runs are highlighted');
    const text = details.append('pre');
    for (const line of lines[i]) {
      if (common.has(line)) text.append('span').text(`${line}\n`);
      else text.append('span').attr('class', 'differs').text(`${line}\n`);
    }
  });
}

function drawFoot() {
  const footer = root.append('footer');
  const details = footer.append('details');
  details.append('summary').text('Generated by Trackbed; licenses of d3, dygraphs and three.js');
  details.append('pre').text(document.getElementById('licenses').textContent);
}
