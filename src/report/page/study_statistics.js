// Draws statistics over all rows of a study: distributions of the outputs, influence of the
// parameters, worst rows.

/**
 * Makes a row of drop-down lists. `add` adds a list and returns a function that gives the list's
 * selected value.
 */
function choicesIn(parent) {
  const choices = parent.append('div').attr('class', 'choices');
  return {
    node: choices,
    add(label, id, list, chosen, draw) {
      const select = choices.append('label').text(label).append('select').attr('id', id);
      for (const [value, name] of list) {
        select.append('option').attr('value', value).property('selected', value === chosen).text(name);
      }
      select.on('change', draw);
      return () => Number(select.node().value);
    },
  };
}

function percent(share, digits = 1) {
  return `${fixed(100 * share, digits)} %`;
}

/** Adds a panel with a title and an empty drawing of the given height [px]. */
function figureIn(parent, title, unit, name, height) {
  const figure = parent.append('figure').attr('class', 'panel').attr('data-output', name);
  const caption = figure.append('figcaption').attr('title', name).text(title);
  if (unit) caption.append('span').text(` [${unit}]`);
  const svg = figure.append('svg').attr('role', 'img').attr('aria-label', title).style('height', `${height}px`);
  return { figure, svg, width: svg.node().getBoundingClientRect().width, height };
}

function drawAxes(svg, { x, y, width, height, margin, nameX, formatY }) {
  svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${height - margin.bottom})`)
    .call(d3.axisBottom(x).ticks(Math.max(3, width / 90)).tickSize(-(height - margin.top - margin.bottom))
      .tickSizeOuter(0).tickPadding(7).tickFormat(shown));
  svg.append('g').attr('class', 'axis').attr('transform', `translate(${margin.left} 0)`)
    .call(d3.axisLeft(y).ticks(5).tickSize(-(width - margin.left - margin.right)).tickSizeOuter(0)
      .tickPadding(7).tickFormat(formatY || shown));
  svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end')
    .attr('x', width - margin.right).attr('y', height - 6).text(nameX);
}

function drawDistributions(parent, { outputs, statistics, nameOf }) {
  const list = parent.append('div').attr('class', 'plots');
  const known = statistics.outputs.filter(({ distribution }) => distribution)
    .map((of) => ({ of, column: outputs.find(({ name }) => name === of.name) })).filter(({ column }) => column);
  function draw() {
    list.text('');
    for (const { of, column } of known) {
      const { svg, width, height } = figureIn(list, column.label, column.unit, column.name, 220);
      svg.attr('aria-label', `Distribution of ${nameOf(column)}`);
      const margin = { left: 56, right: 14, top: 14, bottom: 44 };
      const x = d3.scaleLinear().domain(d3.extent(of.distribution, (d) => d[0])).nice()
        .range([margin.left, width - margin.right]);
      const y = d3.scaleLinear().domain([0, 1]).range([height - margin.bottom, margin.top]);
      drawAxes(svg, { x, y, width, height, margin, nameX: nameOf(column), formatY: (v) => percent(v, 0) });
      svg.append('path').attr('class', 'line').style('color', 'var(--track-0)')
        .attr('d', d3.line().x((d) => x(d[0])).y((d) => y(d[1]))(of.distribution));
    }
  }
  draw();
  new ResizeObserver(draw).observe(list.node());
  const table = parent.append('div').attr('class', 'panel scroll').append('table').attr('id', 'quantiles');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Quantile');
  for (const [share] of known[0].of.quantiles) {
    head.append('th').text(share === 0 ? 'smallest' : share === 1 ? 'largest' : share === 0.5 ? 'median' : percent(share, 0));
  }
  head.append('th').text('rows');
  for (const { of, column } of known) {
    const line = table.append('tbody').append('tr').attr('data-output', column.name);
    withUnit(line.append('th'), column.label, column.unit);
    for (const [, value] of of.quantiles) line.append('td').text(shown(value));
    line.append('td').text(shown(of.count));
  }
}

/** Draws horizontal bars that start at 0, one below the other, with their confidence intervals. */
function drawBars(parent, title, name, bars, { domain, format, formatTick }) {
  const row = 30;
  const { svg, width, height } = figureIn(parent, title, '', name, bars.length * row + 48);
  const margin = { left: Math.min(0.45 * width, 12 + 7.2 * d3.max(bars, (bar) => bar.name.length) || 0), right: 64 };
  const x = d3.scaleLinear().domain([Math.min(domain[0], d3.min(bars, (bar) => bar.interval[0]) || 0), domain[1]])
    .range([margin.left, width - margin.right]);
  svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${height - 36})`)
    .call(d3.axisBottom(x).ticks(Math.max(2, (width - margin.left) / 90)).tickSize(-(height - 40)).tickSizeOuter(0).tickPadding(7)
      .tickFormat(formatTick));
  bars.forEach((bar, i) => {
    const y = 4 + i * row;
    const line = svg.append('g').attr('data-bar', bar.column.name);
    const text = bar.name.length * 7.2 > margin.left ? `${bar.name.slice(0, Math.floor(margin.left / 7.2) - 2)}…` : bar.name;
    line.append('text').attr('x', margin.left - 8).attr('y', y + row / 2 + 1).attr('text-anchor', 'end')
      .attr('class', 'bar-name').text(text).append('title').text(bar.name);
    line.append('rect').attr('class', 'bar-fill').attr('x', x(Math.min(0, bar.value))).attr('y', y + 6)
      .attr('width', Math.abs(x(bar.value) - x(0))).attr('height', row - 14);
    line.append('path').attr('class', 'whisker')
      .attr('d', `M${x(bar.interval[0])},${y + row / 2 - 1}H${x(Math.min(domain[1], bar.interval[1]))}`);
    line.append('text').attr('class', 'bar-name').attr('x', width - margin.right + 8).attr('y', y + row / 2 + 1)
      .text(format(bar.value));
  });
}

/** Draws the rank correlations between a chosen output and the other outputs. */
function drawCorrelations(parent, { outputs, statistics, nameOf }) {
  const known = outputs.filter(({ name }) => statistics.correlations.some((pair) => pair.outputs.includes(name)));
  const choices = choicesIn(parent);
  const chosen = choices.add('With', 'correlation-of', known.map((column, i) => [i, nameOf(column)]), known.length - 1, draw);
  const bars = parent.append('div').attr('class', 'plots wide');
  parent.append('p').attr('class', 'hint').text('Spearman’s rank correlation: 1 where both always rise together, −1 where '
    + 'one falls as the other rises, about 0 of what has nothing to do with each other; lines: 95 % intervals.');
  draw();
  new ResizeObserver(draw).observe(bars.node());

  function draw() {
    const { name } = known[chosen()];
    const others = statistics.correlations.filter((pair) => pair.outputs.includes(name)).map(({ outputs: pair, rho, interval }) => {
      const column = outputs.find((output) => output.name === (pair[0] === name ? pair[1] : pair[0]));
      return { column, name: nameOf(column), value: rho, interval };
    });
    bars.text('');
    drawBars(bars, 'Rank correlation', 'correlations', others.sort((a, b) => Math.abs(b.value) - Math.abs(a.value)),
      { domain: [-1, 1], format: (value) => fixed(value, 2), formatTick: shown });
  }
}

function drawInfluence(parent, { columns, statistics, nameOf }) {
  const named = statistics.outputs.map((of, i) => {
    const column = columns.find(({ name }) => name === of.name);
    return [i, column ? nameOf(column) : 'pass rate'];
  });
  // If the statistics contain the pass rate, it is the first in the list of outputs.
  const rate = statistics.outputs.findIndex(({ name }) => name === 'passed');
  const choices = choicesIn(parent);
  const chosen = choices.add('Of', 'influence-of', named, Math.max(rate, 0), draw);
  const bars = parent.append('div').attr('class', 'plots wide');
  const note = parent.append('p').attr('class', 'hint');
  const list = parent.append('div').attr('class', 'plots');
  draw();
  new ResizeObserver(draw).observe(list.node());

  function draw() {
    const of = statistics.outputs[chosen()];
    const isRate = of.name === 'passed';
    const output = columns.find(({ name }) => name === of.name);
    bars.text('');
    list.text('');
    drawBars(bars, 'Share of the variance', 'indices', of.indices.slice().sort((a, b) => b.index - a.index)
      .map(({ parameter, index, interval }) => (
        { column: columns[parameter], name: nameOf(columns[parameter]), value: index, interval })),
    { domain: [0, 1], format: percent, formatTick: (value) => percent(value, 0) });
    note.text('First-order Sobol’ index: the share of the variance that a parameter explains by itself; lines: 95 % '
      + `intervals. The rest, ${percent(Math.max(0, 1 - d3.sum(of.indices, ({ index }) => index)), 0)}, is due to `
      + 'parameters together, and to chance.');
    const ends = of.effects.flatMap(({ classes }) => classes.flatMap((c) => [c.mean, ...(c.interval || [])]));
    const domain = isRate ? [0, 1] : d3.extent(ends);
    for (const effect of of.effects) {
      drawEffect(effect, { domain, isRate, name: isRate ? 'pass rate' : `mean of ${nameOf(output)}` });
    }
  }

  function drawEffect({ parameter, classes }, { domain, isRate, name }) {
    const column = columns[parameter];
    const title = `${name.charAt(0).toUpperCase()}${name.slice(1)} over ${column.label}`;
    const { svg, width, height } = figureIn(list, title, '', column.name, 220);
    const margin = { left: 56, right: 14, top: 14, bottom: 44 };
    const numeric = classes.every(({ value }) => typeof value === 'number');
    const sorted = numeric ? classes.slice().sort((a, b) => a.value - b.value) : classes;
    const x = numeric ? d3.scaleLinear().domain(d3.extent(sorted, (c) => c.value)).nice()
      : d3.scalePoint().domain(sorted.map((c) => String(c.value))).padding(0.5);
    x.range([margin.left, width - margin.right]);
    const y = d3.scaleLinear().domain(domain).nice().range([height - margin.bottom, margin.top]);
    const most = Math.max(6, Math.floor((width - margin.left) / sorted.length / 7));
    const axisX = d3.axisBottom(x).tickSize(-(height - margin.top - margin.bottom)).tickSizeOuter(0).tickPadding(7)
      .tickFormat((value) => (numeric ? shown(value) : value.length > most ? `${value.slice(0, most - 1)}…` : value));
    if (numeric) axisX.ticks(Math.max(3, width / 90));
    svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${height - margin.bottom})`).call(axisX)
      .selectAll('.tick').append('title').text(String);
    svg.append('g').attr('class', 'axis').attr('transform', `translate(${margin.left} 0)`)
      .call(d3.axisLeft(y).ticks(5).tickSize(-(width - margin.left - margin.right)).tickSizeOuter(0).tickPadding(7)
        .tickFormat(isRate ? (value) => percent(value, 0) : shown));
    svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end')
      .attr('x', width - margin.right).attr('y', height - 6).text(nameOf(column));
    const at = (c) => x(numeric ? c.value : String(c.value));
    if (numeric) {
      svg.append('path').attr('class', 'line').style('color', 'var(--track-0)')
        .attr('d', d3.line().x(at).y((c) => y(c.mean))(sorted));
    }
    const marks = svg.append('g').selectAll('g').data(sorted).enter().append('g');
    marks.filter((c) => c.interval).append('path').attr('class', 'whisker')
      .attr('d', (c) => `M${at(c)},${y(c.interval[0])}V${y(c.interval[1])}`);
    marks.append('circle').attr('class', 'mark').attr('cx', at).attr('cy', (c) => y(c.mean)).attr('r', 4)
      .append('title').text((c) => `${shown(c.value)}: ${isRate ? percent(c.mean) : shown(c.mean)} of ${c.count} rows`);
  }
}

/**
 * Draws the worst rows by a chosen output. If `lowest` is true, the lowest values are initially
 * treated as the worst; otherwise the highest.
 */
function drawWorst(parent, { study, outputs, parameters, rows, nameOf, lowest }) {
  const choices = choicesIn(parent);
  const chosen = choices.add('By', 'worst-by', outputs.map((column) => [column.index, nameOf(column)]), outputs[0].index, draw);
  const order = choices.add('Worst are the', 'worst-order', [[1, 'highest'], [-1, 'lowest']], lowest ? -1 : 1, draw);
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  draw();

  function draw() {
    const column = outputs.find(({ index }) => index === chosen());
    table.text('');
    const head = table.append('thead').append('tr');
    withUnit(head.append('th'), column.label, column.unit);
    for (const parameter of parameters) withUnit(head.append('th').attr('class', 'brief'), parameter.label, parameter.unit);
    if (study.folder) head.append('th').attr('class', 'text').text('Run it again');
    const worst = rows.filter((row) => row.cells[column.index] !== null)
      .sort((a, b) => order() * (b.cells[column.index] - a.cells[column.index]) || a.number - b.number).slice(0, 10);
    const lines = table.append('tbody').selectAll('tr').data(worst).enter().append('tr')
      .attr('data-number', (row) => row.number);
    lines.append('td').text((row) => shown(row.cells[column.index]));
    for (const parameter of parameters) lines.append('td').text((row) => shown(row.cells[parameter.index]));
    if (study.folder) {
      lines.append('td').attr('class', 'text').append('code')
        .text((row) => `trackbed run --from-sweep ${shellWord(study.folder)} --row ${row.number} --video --report`);
    }
  }
}

function shellWord(word) {
  return /^[\w./+-]+$/.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`;
}

/**
 * Draws the differences between two studies, after minus before a change. Rows with equal settings
 * are paired.
 */
function drawDifference(parent, { study, columns }) {
  const { rows, only_before: before, only_after: after, outputs } = study.difference;
  parent.append('p').attr('class', 'hint').text(`${rows} rows that set the same in both`
    + (before || after ? `; ${before} are only there, ${after} only here` : '')
    + '. Differences are this study less that one, with the 95 % interval of their mean; p: exact two-sided sign test.');
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Output');
  for (const name of ['mean before', 'mean now', 'mean difference', '95 % interval', 'median difference', 'higher', 'lower', 'equal', 'p']) {
    head.append('th').attr('class', 'brief').text(name);
  }
  for (const of of outputs) {
    const column = columns.find(({ name }) => name === of.name);
    const line = table.append('tbody').append('tr').attr('data-output', of.name);
    if (column) withUnit(line.append('th'), column.label, column.unit);
    else line.append('th').text('pass rate');
    const value = (number, digits) => (column ? shown(number) : percent(number, digits));
    line.append('td').text(value(of.before));
    line.append('td').text(value(of.after));
    line.append('td').text(value(of.mean));
    line.append('td').text(of.interval ? `${value(of.interval[0])} to ${value(of.interval[1])}` : '–');
    line.append('td').text(column ? shown(of.median) : '–');
    line.append('td').text(shown(of.higher));
    line.append('td').text(shown(of.lower));
    line.append('td').text(shown(of.equal));
    line.append('td').text(of.sign_test < 1e-4 ? '< 0.0001' : fixed(of.sign_test, 4));
  }
}
