// Draws the page of a search for failures: the result, the margins of each key, the history, and
// the tried parts of the ranges.
// 1. The margin of a varied key is the distance from its nominal value to the values at which runs
//    failed.
// 2. The history chart shows the robustness of each run in the order of the runs; a run with a
//    robustness below 0 failed.
// 3. The symbol and the color of a run show its phase: nominal point, search, shrinking.

// Phases of a search for failures, with the symbol and color of the runs in each phase.
const PHASES = [
  { name: 'nominal', label: 'nominal point', symbol: d3.symbolDiamond, color: 'var(--text)' },
  { name: 'search', label: 'search', symbol: d3.symbolCircle, color: 'var(--track-0)' },
  { name: 'shrink', label: 'making the failure smaller', symbol: d3.symbolTriangle, color: 'var(--track-1)' },
];

function runsText(count) {
  return `${count} ${count === 1 ? 'run' : 'runs'}`;
}

function verdictOfSearch({ status, runs, violations }) {
  if (status === 'interrupted') return `interrupted after ${runs} runs`;
  return status === 'broken' ? `broken: ${violations} of ${runs} runs failed` : `not falsified in ${runs} runs`;
}

function factsOfSearch({ method, runs, shrink_runs: shrink, out_of_time: late }, { row_count: rows, rows: shownRows, columns }) {
  const status = columns.findIndex(({ kind }) => kind === 'status');
  const lost = shownRows.filter((cells) => ['refused', 'error'].includes(cells[status])).length;
  return [
    `search ${method}: ${runsText(runs)}${shrink ? `, and ${shrink} to make the failure smaller` : ''}`,
    late && 'the time was up',
    lost > 0 && `without a result: ${lost} of ${rows} rows`,
  ];
}

/** Formats a value with the number of digits that the search uses. */
function keyValue(value) {
  return value === null || value === undefined ? '–' : d3.format('.5~r')(value).replace('-', '−');
}

/**
 * Returns the position of a value in its range, from 0 to 1. In a logarithmic range, equal ratios
 * have equal widths. In a range of whole numbers, each number has the same width.
 */
function placeInRange({ kind, from, to }, value) {
  if (kind === 'log_uniform') return Math.log(value / from) / Math.log(to / from);
  return kind === 'integer' ? (value - from + 0.5) / (to - from + 1) : (value - from) / (to - from);
}

function valueInRange({ kind, from, to }, place) {
  if (kind === 'log_uniform') return from * (to / from) ** place;
  return kind === 'integer' ? from - 0.5 + place * (to - from + 1) : from + place * (to - from);
}

/**
 * Returns ticks at 1, 2 and 5 times powers of ten or, if these are too many, only at powers of ten.
 */
function ticksOfLogarithm(scale) {
  const digits = (list) => scale.ticks(100).filter((tick) => list.includes(Math.round(tick / 10 ** Math.floor(Math.log10(tick) + 1e-9))));
  return digits([1, 2, 5]).length > 10 ? digits([1]) : digits([1, 2, 5]);
}

/**
 * Returns the points of a search that have a mark, each with its values by key: the nominal point
 * and the counterexample, if any.
 */
function marksOfSearch({ keys, counterexample }) {
  const nominal = { kind: 'point', at: Object.fromEntries(keys.map(({ name, nominal: value }) => [name, value])) };
  return counterexample ? [nominal, { kind: 'counterexample', at: counterexample.settings }] : [nominal];
}

function signOfPoint(kind, size = 90) {
  return d3.symbol().type(kind === 'counterexample' ? d3.symbolStar : d3.symbolDiamond).size(size)();
}

function signIn(legend, text) {
  const sign = legend.append('span').attr('class', 'sign');
  const svg = sign.append('svg').attr('width', 16).attr('height', 16).append('g').attr('transform', 'translate(8 8)');
  sign.append('span').text(text);
  return svg;
}

/** Draws the legend of the marked points of a search. */
function drawSigns(legend, search) {
  for (const { kind } of marksOfSearch(search)) {
    signIn(legend, kind === 'point' ? 'nominal point' : 'counterexample').append('path').attr('class', `sign-of ${kind}`).attr('d', signOfPoint(kind));
  }
}

function drawSearch({ study, search, columns, rows, isGood, bus, tooltip }) {
  const found = search.counterexample || search.least_robust;
  if (found) drawFound(section('answer', search.counterexample ? 'Counterexample' : 'Lowest robustness'), { study, search, found });
  drawMargins(section('margins', search.keys.some(({ margin }) => margin) ? 'How far each key holds' : 'Keys'), search);
  const of = Object.fromEntries(['robustness', 'phase', 'status'].map((name) => [name, columns.findIndex((column) => column.name === name)]));
  if (of.robustness < 0 || of.phase < 0) return;
  const sorted = rows.slice().sort((a, b) => a.number - b.number);
  drawHistory(section('history', 'How the search went'), { search, rows: sorted, of, isGood, bus, tooltip });
  drawCoverage(section('coverage', 'What was tried'), { search, rows: sorted, of, isGood, bus, tooltip });
}

function drawFound(parent, { study, search, found }) {
  const { counterexample, least_robust: least, first_violation: first, shrink_runs: shrink } = search;
  const panel = parent.append('div').attr('class', 'panel');
  panel.append('p').attr('class', 'reason').text(found.reason || `No run failed. The nearest to it is row ${found.row}.`);
  const list = panel.append('ul').attr('class', 'found');
  const say = (name, size, text) => {
    const line = list.append('li');
    line.append('span').text(name);
    line.append('strong').text(size);
    line.append('span').attr('class', 'hint').text(text);
  };
  say('Robustness', shown(found.robustness), `of ${found.limit}; a run fails below 0`
    + (counterexample && least.row !== found.row ? `; the lowest of all is ${shown(least.robustness)}, row ${least.row}` : ''));
  say('Distance from the nominal point', brief(found.distance), found.row === 0 ? 'the nominal point itself fails'
    : `Euclidean, each key in shares of its range${search.keys.some(({ kind }) => kind === 'log_uniform') ? ', of logarithmic ones in logarithms' : ''}`);
  if (counterexample && found.row !== 0) {
    say('Runs to make it smaller', shown(shrink), (shrink ? `the first failure is row ${first.row}, at a distance of ${brief(first.distance)}`
      : 'it is as it was found') + (search.shrunk_completely ? '' : '; they were not enough'));
  }
  if (!counterexample) {
    panel.append('p').attr('class', 'note').text(`It is at ${search.keys.map(({ name, unit }) => (
      `${name} = ${keyValue(found.settings[name])}${unit ? ` ${unit}` : ''}`)).join(', ')}.`);
    panel.append('p').attr('class', 'note').text('This is what was tried. It does not prove that no other run fails.');
  }
  if (search.scenario) panel.append('p').attr('class', 'note').text('For a test suite: ').append('code').text(search.scenario);
  if (study.folder) {
    panel.append('p').attr('class', 'note').text('Run it again: ').append('code')
      .text(`trackbed run --from-sweep ${shellWord(study.folder)} --row ${found.row} --video --report`);
  }
}

function drawMargins(parent, { keys, counterexample }) {
  const hasMargins = keys.some(({ margin }) => margin);
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Key');
  const names = ['Nominal', ...(counterexample ? ['Fails at'] : []),
    ...(hasMargins ? ['Holds up to', 'Alone holds', 'Sensitivity'] : []), 'Searched'];
  for (const name of names) head.append('th').text(name);
  const body = table.append('tbody');
  for (const key of keys) {
    const line = body.append('tr').attr('data-key', key.name);
    withUnit(line.append('th').attr('scope', 'row'), key.label, key.unit);
    line.append('td').text(keyValue(key.nominal));
    if (counterexample) line.append('td').attr('class', 'bad').text(keyValue(counterexample.settings[key.name]));
    if (hasMargins) {
      const { alone, holds_up_to: holds, sensitivity } = key.margin;
      line.append('td').text(keyValue(holds));
      line.append('td').text(!alone ? '–' : `${keyValue(alone[0])} to ${keyValue(alone[1])}`);
      line.append('td').text(sensitivity === null ? '–' : `${sensitivity > 0 ? '+' : ''}${brief(sensitivity)}`);
    }
    line.append('td').text(`${keyValue(key.from)} to ${keyValue(key.to)}${key.kind === 'log_uniform' ? ', logarithmic' : ''}`);
  }
  if (hasMargins) {
    parent.append('p').attr('class', 'hint').text('Holds up to: the nearest value that passes, all other keys at the counterexample’s. '
      + 'Alone holds: how far the key can go with all other keys at their nominal values; failures in between are not seen. '
      + 'Sensitivity: what the whole range of the key would change the robustness by, from runs beside the counterexample; + where more of it is safer.');
  }
}

/**
 * Returns a scale for values of the robustness, as {scale, ticks, note}. The scale is linear, or
 * symmetric logarithmic if the values differ by orders of magnitude.
 */
function scaleOfRobustness(values) {
  const sizes = values.map(Math.abs).filter((size) => size > 0).sort(d3.ascending);
  const extent = d3.extent([0, ...values]);
  const most = d3.max(sizes) || 1;
  const small = Math.min(d3.median(sizes) || 1, extent[1] > 0 ? extent[1] : Infinity);
  if (most <= 20 * small) {
    const scale = d3.scaleLinear().domain(extent).nice();
    return { scale, ticks: scale.ticks(5), note: '' };
  }
  const unit = 10 ** Math.floor(Math.log10(Math.max(small, 1e-4 * most)));
  const powers = d3.range(0, Math.floor(Math.log10(most / unit)) + 1).map((k) => Number((unit * 10 ** k).toPrecision(1)));
  const ticks = [...powers.map((power) => -power).reverse(), 0, ...powers].filter((tick) => tick >= extent[0] && tick <= extent[1]);
  return { scale: d3.scaleSymlog().constant(unit).domain(extent), ticks, note: ` (logarithmic beyond ±${shown(unit)})` };
}

/**
 * Returns the color scale of the robustness. Failed runs are red and passed runs blue. Colors
 * become darker with increasing distance from 0, and are never white.
 */
function colorsOfRobustness(cells) {
  const values = cells.filter((value) => value !== null);
  const { scale } = scaleOfRobustness(values);
  const [least, most] = d3.extent(values);
  scale.range([0, 1]);
  const zero = scale(0);
  const far = Math.max(Math.abs(scale(least) - zero), Math.abs(scale(most) - zero)) || 1;
  return {
    color: (value) => d3.interpolateRdBu(0.5 + (value < 0 ? -0.5 : 0.5) * (0.2 + 0.65 * Math.abs(scale(value) - zero) / far)),
    at: (share) => scale.invert(scale(least) + share * (scale(most) - scale(least))),
  };
}

function drawHistory(parent, { search, rows, of, isGood, bus, tooltip }) {
  const robustnessOf = (row) => row.cells[of.robustness];
  const has = (row) => robustnessOf(row) !== null;
  const phaseOf = (row) => PHASES.find(({ name }) => name === row.cells[of.phase]) || PHASES[1];
  const there = rows.filter(has);
  const lost = rows.filter((row) => !has(row));
  const legend = parent.append('div').attr('class', 'legend');
  for (const phase of PHASES.filter((of) => rows.some((row) => phaseOf(row) === of))) {
    signIn(legend, phase.label).append('path').attr('class', 'run').style('color', phase.color).attr('d', d3.symbol().type(phase.symbol).size(60)());
  }
  if (there.some((row) => !isGood(row))) signIn(legend, 'hollow: failed').append('circle').attr('class', 'run failed').attr('r', 4.5);
  if (search.counterexample) signIn(legend, 'counterexample').append('circle').attr('class', 'ring').attr('r', 6.5);
  signIn(legend, 'lowest so far').append('path').attr('class', 'best').attr('d', 'M-8 -4H0V4H8');
  signIn(legend, 'a run fails below 0').append('path').attr('class', 'zero').attr('d', 'M-8 0H8');
  if (lost.length) signIn(legend, 'no result').append('path').attr('class', 'lost').attr('d', 'M-3 -3L3 3M-3 3L3 -3');
  const plots = parent.append('div').attr('class', 'plots wide');
  draw();
  new ResizeObserver(draw).observe(plots.node());
  bus.on('choose.history', (row) => plots.selectAll('.runs .run').classed('chosen', (d) => d === row));

  function draw() {
    plots.text('');
    const values = there.map(robustnessOf);
    const { svg, width, height } = figureIn(plots, 'Robustness of each run', '', 'history', 300);
    const lowest = d3.min(values);
    svg.attr('aria-label', `Robustness over the number of the run: of ${runsText(there.length)} `
      + `${there.filter((row) => !isGood(row)).length} failed, the lowest is ${brief(lowest)}`);
    const margin = { left: 56, right: 18, top: 30, bottom: 44 };
    const { scale: y, ticks, note } = scaleOfRobustness(values);
    // Leaves space in the chart for run symbols at the ends of the axis.
    y.range([height - margin.bottom - 12, margin.top + 8]);
    const x = d3.scaleLinear().domain([0, Math.max(1, d3.max(rows, (row) => row.number) || 1)]).range([margin.left + 8, width - margin.right - 8]);
    svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${height - margin.bottom})`)
      .call(d3.axisBottom(x).tickValues(x.ticks(Math.max(3, width / 90)).filter(Number.isInteger)).tickSizeOuter(0).tickPadding(7).tickFormat(shown));
    svg.append('g').attr('class', 'axis').attr('transform', `translate(${margin.left} 0)`)
      .call(d3.axisLeft(y).tickValues(ticks).tickSize(-(width - margin.left - margin.right)).tickSizeOuter(0).tickPadding(7).tickFormat(shown))
      .select('.domain').remove();
    svg.append('text').attr('class', 'axis-name').attr('x', 8).attr('y', 14).text(`↑ robustness${note}`);
    svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end').attr('x', width - margin.right).attr('y', height - 6).text('run (row of sweep.csv) →');
    svg.append('path').attr('class', 'zero').attr('d', `M${margin.left} ${y(0)}H${width - margin.right}`);
    const best = search.best.length ? [...search.best, [search.runs - 1, search.best[search.best.length - 1][1]]] : [];
    svg.append('path').attr('class', 'best').attr('d', d3.line().curve(d3.curveStepAfter).x((d) => x(d[0])).y((d) => y(d[1]))(best));
    svg.append('g').selectAll('path').data(lost).enter().append('path').attr('class', 'lost')
      .attr('d', (row) => `M${x(row.number) - 3} ${height - margin.bottom - 8}l6 6m-6 0l6 -6`);
    svg.append('g').attr('class', 'runs').selectAll('path').data(there).enter().append('path')
      .attr('class', 'run').classed('failed', (row) => !isGood(row)).style('color', (row) => phaseOf(row).color)
      .attr('data-row', (row) => row.index).attr('data-phase', (row) => row.cells[of.phase])
      .attr('transform', (row) => `translate(${x(row.number)} ${y(robustnessOf(row))})`)
      .attr('d', (row) => d3.symbol().type(phaseOf(row).symbol).size(there.length > 200 ? 24 : 50)())
      .on('mouseenter click', tooltip.show).on('mouseleave', tooltip.hide);
    const { counterexample } = search;
    if (counterexample) {
      svg.append('circle').attr('class', 'ring').attr('r', 8.5).attr('cx', x(counterexample.row)).attr('cy', y(counterexample.robustness));
    }
  }
}

function drawCoverage(parent, { search, rows, of, isGood, bus, tooltip }) {
  const shares = search.keys.map(({ label, tried }, i) => (
    `${tried.filter(Boolean).length} of ${tried.length}${i ? '' : ' equal intervals'} of ${label}`));
  parent.append('p').attr('class', 'sentence').text(`Runs were in ${shares.join(', ')}.`);
  const legend = parent.append('div').attr('class', 'legend');
  drawSigns(legend, search);
  signIn(legend, 'no run in the interval').append('rect').attr('class', 'cell none').attr('x', -7).attr('y', -6).attr('width', 14).attr('height', 12);
  const plots = parent.append('div').attr('class', 'plots');
  parent.append('p').attr('class', 'hint').text('Of each key by itself; which two values were tried together is on the map.');
  const there = rows.filter((row) => row.cells[of.robustness] !== null);
  draw();
  new ResizeObserver(draw).observe(plots.node());
  bus.on('choose.coverage', (row) => plots.selectAll('.tick-of').classed('chosen', (d) => d === row));

  function draw() {
    plots.text('');
    for (const key of search.keys) drawKey(key);
  }

  function drawKey(key) {
    const { svg, width } = figureIn(plots, key.label, key.unit, key.name, 128);
    const count = key.tried.length;
    const visited = key.tried.filter(Boolean).length;
    svg.attr('aria-label', `${key.label}: runs were in ${visited} of ${count} equal intervals from ${keyValue(key.from)} to ${keyValue(key.to)}, `
      + `failures in ${key.failed.filter(Boolean).length}`);
    const left = 60;
    const right = width - 22;
    const [top, middle, bottom] = [22, 48, 74];
    const at = (value) => left + placeInRange(key, value) * (right - left);
    const step = (right - left) / count;
    for (const i of d3.range(count)) {
      const ends = [i, i + 1].map((edge) => keyValue(Number(valueInRange(key, edge / count).toPrecision(4))));
      svg.append('rect').attr('class', key.tried[i] ? 'cell tried' : 'cell none').attr('x', left + i * step + 0.5).attr('y', top)
        .attr('width', Math.max(1, step - 1)).attr('height', bottom - top)
        .append('title').text(`${ends.join(' to ')}: ${runsText(key.tried[i])}, ${key.failed[i]} failed`);
    }
    svg.append('text').attr('class', 'bar-name').attr('text-anchor', 'end').attr('x', left - 8).attr('y', (top + middle) / 2 + 1).text('passed');
    svg.append('text').attr('class', 'bar-name').attr('text-anchor', 'end').attr('x', left - 8).attr('y', (middle + bottom) / 2 + 1).text('failed');
    svg.append('g').attr('class', 'ticks').selectAll('path').data(there).enter().append('path')
      .attr('class', 'tick-of').classed('failed', (row) => !isGood(row)).attr('data-row', (row) => row.index)
      .attr('d', (row) => `M${at(row.cells[key.column])} ${isGood(row) ? top + 3 : middle + 2}v${middle - top - 5}`)
      .on('mouseenter click', tooltip.show).on('mouseleave', tooltip.hide);
    const axis = (key.kind === 'log_uniform' ? d3.scaleLog() : d3.scaleLinear()).domain([key.from, key.to]).range([at(key.from), at(key.to)]);
    // The axis of a key has ticks at both ends of the range and, if there is space, between the
    // ends.
    const inner = (key.kind === 'log_uniform' ? ticksOfLogarithm(axis)
      : axis.ticks(Math.max(2, Math.min(key.kind === 'integer' ? key.to - key.from : 8, width / 70))))
      .filter((tick) => axis(tick) > at(key.from) + 36 && axis(tick) < at(key.to) - 36);
    const ticks = [key.from, ...inner, key.to];
    svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${bottom + 16})`)
      .call(d3.axisBottom(axis).tickValues(ticks).tickSizeOuter(0).tickPadding(6).tickFormat(shown));
    for (const { kind, at: values } of marksOfSearch(search)) {
      const height = kind === 'counterexample' ? bottom + 8 : top - 9;
      svg.append('path').attr('class', `sign-of ${kind}`).attr('d', signOfPoint(kind, 70)).attr('transform', `translate(${at(values[key.name])} ${height})`);
    }
  }
}
