// Draws the page of a study: the outputs over the parameters, and the table of all rows.
// 1. The columns of the study are divided by their kind: parameters, status, outputs.
// 2. The function drawPlots draws the outputs over a parameter that the user selects. A second
//    parameter determines the color of the dots.
// 3. Each dot of a plot is a row of the study. Pointing at a dot shows its row in the tooltip, in
//    all plots and in the table.
// 4. The function drawStudyTable sorts and filters the rows.

function drawStudy(study) {
  const columns = study.columns.map((column, index) => ({ ...column, index }));
  const of = (kind) => columns.filter((column) => column.kind === kind);
  const parameters = of('parameter');
  const status = of('status')[0];
  const rows = study.rows.map((cells, index) => ({ index, cells, number: study.row_numbers[index] }));
  // The page of a large study contains only evenly spaced rows, plus the rows with the extremes of
  // each output.
  const even = rows.slice(0, study.even_count);
  const isGood = (row) => ['passed', 'found', 'passes_at_to'].includes(row.cells[status.index]);
  const isNumber = (column) => rows.some((row) => typeof row.cells[column.index] === 'number')
    && rows.every((row) => row.cells[column.index] === null || typeof row.cells[column.index] === 'number');
  const nameOf = (column) => `${column.label}${column.unit ? ` [${column.unit}]` : ''}`;

  const header = root.append('header');
  const heading = header.append('div').attr('class', 'heading');
  heading.append('h1').text(study.name);
  const complete = study.complete !== false || Boolean(study.stopped);
  const { search } = study;
  const verdict = heading.append('span').attr('id', 'verdict');
  if (search) {
    verdict.attr('class', search.status === 'not_falsified' ? 'badge plain' : 'badge bad').text(verdictOfSearch(search));
  } else {
    verdict.attr('class', complete ? 'badge plain' : 'badge bad').text(complete ? `${study.passed_count} of ${study.row_count} rows passed`
      : `interrupted: ${study.row_count} of ${study.rows_expected} rows`);
  }
  const { statistics } = study;
  if (statistics) {
    const [low, high] = statistics.pass_interval;
    header.append('p').attr('id', 'pass-rate').text(`Pass rate ${percent(statistics.pass_rate)}, 95 % interval `
      + `${percent(low)} to ${percent(high)} (Wilson)`
      + (statistics.without_result ? `; without ${statistics.without_result} rows that were not run` : ''));
  }
  facts(header, [
    study.scenario && `scenario ${study.scenario}`,
    parameters.length > 0 && `${parameters.length} ${parameters.length === 1 ? 'parameter' : 'parameters'}: ${parameters.map(nameOf).join(', ')}`,
    ...(search ? factsOfSearch(search, study) : []),
    study.stopped && `stopped at ${study.stopped}, after ${study.row_count} of ${study.rows_expected} rows`,
    rows.length < study.row_count && `drawn one by one: ${even.length} rows, evenly chosen, and the ends of each output; `
      + `statistics are of all ${study.row_count}`,
    study.versions && `Trackbed ${study.versions.trackbed}`, study.versions && study.versions.physics,
  ]);

  const outputs = of('output').filter((column) => column.name !== 'runs' && isNumber(column));
  const bus = d3.dispatch('choose');
  const tooltip = tooltipOfRows({ parameters, outputs, told: of('output').filter(({ name }) => search && name === 'phase'), nameOf, bus });
  if (study.difference) drawDifference(section('difference', `Against ${study.difference.before}`), { study, columns });
  const varied = parameters.filter((p) => new Set(rows.map((row) => row.cells[p.index])).size > 1);
  const drawOutputs = () => {
    if (!parameters.length || !outputs.length || !rows.length) return;
    drawPlots(section('plots', study.bisected ? `Limits of ${study.bisected}` : 'Outputs over a parameter'),
      { parameters, outputs, rows: even, isGood, isNumber, nameOf, bus, tooltip, search });
  };
  if (search) {
    drawSearch({ study, search, columns, rows, isGood, bus, tooltip });
  } else if (outputs.length && rows.length) {
    drawStudyAnswer(section('answer', study.bisected ? 'Found' : ''), { study, outputs, varied, rows, status });
  }
  // The result of a bisection is the value found for the varied key, so the chart of this value is
  // drawn first.
  if (study.bisected) drawOutputs();
  if (statistics && statistics.outputs.length && varied.length) {
    drawInfluence(section('influence', 'What matters'), { columns, statistics, nameOf });
  }
  if (varied.length > 1 && even.length) {
    drawStudyMap(section('study-map', 'Map'), { parameters: varied, outputs, rows: even, isGood, isNumber, nameOf, search });
  }
  if (statistics && statistics.outputs.some(({ distribution }) => distribution)) {
    drawDistributions(section('distributions', 'Distributions'), { outputs, statistics, nameOf });
  }
  if (statistics && statistics.correlations.length) {
    drawCorrelations(section('correlations', 'Which results go together'), { outputs, statistics, nameOf });
  }
  if (!study.bisected) drawOutputs();
  if (outputs.length && rows.length > 10) {
    drawWorst(section('worst', 'Worst rows'), { study, outputs, parameters: varied, rows, nameOf, lowest: Boolean(search) });
  }
  drawStudyTable(section('table', 'All rows'), { columns, rows, isGood, isNumber, bus });
  if (study.text) {
    const details = section('scenario', 'Study').append('details').attr('class', 'panel');
    details.append('summary').text('sweep.json');
    details.append('pre').text(study.text);
  }
}

/**
 * Makes a tooltip that shows the settings and outputs of a row. While the tooltip is shown, the row
 * is also highlighted in plots and table.
 */
function tooltipOfRows({ parameters, outputs, told, nameOf, bus }) {
  const tooltip = d3.select('body').append('div').attr('class', 'tooltip panel').attr('hidden', '');
  return {
    show(row) {
      tooltip.text('').attr('hidden', null);
      const say = (name, value) => {
        const line = tooltip.append('p');
        line.append('span').text(name);
        line.append('span').text(shown(value));
      };
      say('row', row.number);
      for (const column of [...told, ...parameters, ...outputs.slice(0, 8)]) say(nameOf(column), row.cells[column.index]);
      const box = tooltip.node().getBoundingClientRect();
      const event = d3.event;
      const left = Math.min(event.pageX + 14, window.scrollX + document.documentElement.clientWidth - box.width - 8);
      tooltip.style('left', `${Math.max(8, left)}px`).style('top', `${event.pageY + 16}px`);
      bus.call('choose', null, row);
    },
    hide() {
      tooltip.attr('hidden', '');
      bus.call('choose', null, null);
    },
  };
}

function drawPlots(parent, { parameters, outputs, rows, isGood, isNumber, nameOf, bus, tooltip, search }) {
  const choices = parent.append('div').attr('class', 'choices');
  const choice = (label, id, list, chosen) => {
    const select = choices.append('label').text(label).append('select').attr('id', id);
    for (const [value, name] of list) {
      select.append('option').attr('value', value).property('selected', value === chosen).text(name);
    }
    return () => Number(select.on('change', draw).node().value);
  };
  const varied = parameters.filter((p) => new Set(rows.map((row) => row.cells[p.index])).size > 1);
  const list = (varied.length ? varied : parameters).map((p) => [p.index, nameOf(p)]);
  const first = (varied.find(isNumber) || varied[0] || parameters[0]).index;
  const second = varied.find((p) => p.index !== first);
  const over = choice('Over', 'over', list, first);
  const color = list.length > 1
    ? choice('Color by', 'colors', [[-1, 'nothing'], ...list], second ? second.index : -1) : () => -1;
  const legend = choices.append('div').attr('class', 'legend');
  const plots = parent.append('div').attr('class', 'plots');
  over();
  color();
  draw();
  new ResizeObserver(draw).observe(plots.node());
  bus.on('choose.plots', (row) => plots.selectAll('circle').classed('chosen', (d) => d === row));

  function draw() {
    const x = parameters.find((p) => p.index === over());
    const by = parameters.find((p) => p.index === color() && p !== x);
    const kinds = by ? Array.from(new Set(rows.map((row) => row.cells[by.index]))) : [null];
    if (by && isNumber(by)) kinds.sort(d3.ascending);
    // Up to eight values get distinct colors; more numeric values get a color scale.
    const colors = kinds.map((kind, i) => (kinds.length <= 8 || !isNumber(by)
      ? `var(--track-${i % 8})` : d3.interpolateViridis(0.9 * i / (kinds.length - 1))));
    const cssOf = (row) => colors[by ? kinds.indexOf(row.cells[by.index]) : 0];
    legend.text('');
    if (by) {
      const step = kinds.length <= 12 ? 1 : (kinds.length - 1) / 4;
      for (const i of d3.range(0, kinds.length - 1e-9, step).map(Math.round)) {
        const sign = legend.append('span').attr('class', 'sign');
        sign.append('span').attr('class', 'dot').style('color', colors[i]);
        sign.append('span').text(shown(kinds[i]));
      }
    }
    if (rows.some((row) => !isGood(row))) {
      const sign = legend.append('span').attr('class', 'sign');
      sign.append('svg').attr('width', 12).attr('height', 12).append('circle').attr('cx', 6).attr('cy', 6)
        .attr('r', 4.5).attr('fill', 'none').attr('stroke', 'currentColor').attr('stroke-width', 1.5);
      sign.append('span').text('hollow: failed');
    }
    // Lines in the chart connect rows that differ only in the parameter of the x axis.
    const others = parameters.filter((p) => p !== x);
    const groups = d3.nest()
      .key((row) => JSON.stringify(others.map((p) => row.cells[p.index]))).entries(rows);
    plots.text('');
    for (const output of outputs) drawPlot(output, { x, groups, cssOf });
  }

  function drawPlot(output, { x, groups, cssOf }) {
    const figure = plots.append('figure').attr('class', 'panel').attr('data-output', output.name);
    const caption = figure.append('figcaption').attr('title', output.name).text(output.label);
    if (output.unit) caption.append('span').text(` [${output.unit}]`);
    const svg = figure.append('svg').attr('role', 'img').attr('aria-label', `${nameOf(output)} over ${nameOf(x)}`);
    const { width, height } = svg.node().getBoundingClientRect();
    const margin = { left: 56, right: 14, top: 14, bottom: 44 };
    const has = (row) => row.cells[output.index] !== null && row.cells[x.index] !== null;
    const there = rows.filter(has);
    const values = there.map((row) => row.cells[x.index]);
    const numeric = isNumber(x);
    const scaleX = numeric
      ? d3.scaleLinear().domain(d3.extent(values)).nice()
      : d3.scalePoint().domain(Array.from(new Set(values))).padding(0.5);
    scaleX.range([margin.left, width - margin.right]);
    const range = d3.extent(there, (row) => row.cells[output.index]);
    // The axis includes zero if all values are positive and the smallest is less than half of the
    // largest.
    if (range[0] > 0 && range[0] < 0.5 * range[1]) range[0] = 0;
    if (range[0] === range[1]) { range[0] -= 1; range[1] += 1; }
    // For a search, the robustness axis has the same scale as in the chart of the search's history.
    const { scale: scaleY, ticks, note } = search && output.name === 'robustness' && there.length
      ? scaleOfRobustness(there.map((row) => row.cells[output.index])) : { scale: d3.scaleLinear().domain(range).nice(), note: '' };
    scaleY.range([height - margin.bottom - (ticks ? 6 : 0), margin.top]);
    if (note) caption.append('span').text(note);
    const axisX = d3.axisBottom(scaleX).tickSize(-(height - margin.top - margin.bottom)).tickSizeOuter(0).tickPadding(7)
      .tickFormat((value) => (numeric ? shown(value) : short(value)));
    if (numeric) axisX.ticks(Math.max(3, width / 80));
    svg.append('g').attr('class', 'axis').attr('transform', `translate(0 ${height - margin.bottom})`).call(axisX);
    svg.append('g').attr('class', 'axis').attr('transform', `translate(${margin.left} 0)`)
      .call(d3.axisLeft(scaleY).ticks(5).tickValues(ticks || null).tickSize(-(width - margin.left - margin.right)).tickSizeOuter(0).tickPadding(7).tickFormat(shown));
    svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end')
      .attr('x', width - margin.right).attr('y', height - 6).text(nameOf(x));
    const px = (row) => scaleX(row.cells[x.index]);
    const py = (row) => scaleY(row.cells[output.index]);
    if (numeric) {
      for (const { values: group } of groups) {
        const line = group.filter(has).sort((a, b) => a.cells[x.index] - b.cells[x.index]);
        if (line.length < 2) continue;
        svg.append('path').attr('class', 'line').style('color', cssOf(line[0]))
          .attr('d', d3.line().x(px).y(py)(line));
      }
    }
    svg.append('g').attr('class', 'dots').selectAll('circle').data(there).enter().append('circle')
      .attr('cx', px).attr('cy', py).attr('r', there.length > 200 ? 2.5 : 4)
      .attr('data-row', (row) => row.index)
      .classed('failed', (row) => !isGood(row)).style('color', cssOf)
      .on('mouseenter click', tooltip.show).on('mouseleave', tooltip.hide);
  }

  function short(value) {
    const text = shown(value);
    return text.length > 16 ? `${text.slice(0, 15)}…` : text;
  }
}

function drawStudyTable(parent, { columns, rows, isGood, isNumber, bus }) {
  const table = parent.append('div').attr('class', 'panel scroll tall').append('table');
  const head = table.append('thead').append('tr');
  const body = table.append('tbody').attr('class', 'pointed');
  const sorted = { column: null, down: false };
  for (const column of columns) {
    column.numeric = isNumber(column);
    const cell = head.append('th').attr('class', column.numeric ? 'sortable' : 'text sortable')
      .attr('data-column', column.name);
    withUnit(cell.append('button').attr('type', 'button').attr('title', `${column.name}: sort`), column.label, column.unit)
      .on('click', () => sort(column));
  }
  const lines = body.selectAll('tr').data(rows).enter().append('tr').attr('data-row', (row) => row.index)
    .on('mouseenter', (row) => bus.call('choose', null, row))
    .on('mouseleave', () => bus.call('choose', null, null));
  for (const column of columns) {
    lines.append('td').attr('class', column.numeric ? null : 'text')
      .classed('bad', (row) => column.kind === 'status' && !isGood(row))
      .classed('good', (row) => column.kind === 'status' && isGood(row))
      .text((row) => shown(row.cells[column.index]));
  }
  bus.on('choose.table', (row) => lines.classed('chosen', (d) => d === row));

  function sort(column) {
    sorted.down = sorted.column === column && !sorted.down;
    sorted.column = column;
    head.selectAll('th').attr('aria-sort', null);
    head.selectAll('th').filter((_, i) => i === column.index).attr('aria-sort', sorted.down ? 'descending' : 'ascending');
    const sign = sorted.down ? -1 : 1;
    lines.sort((a, b) => {
      const [left, right] = [a.cells[column.index], b.cells[column.index]];
      // In a sorted table, empty cells come last, both in ascending and in descending order.
      if (left === null || right === null) return (left === null) - (right === null) || a.index - b.index;
      const order = column.numeric ? left - right : d3.ascending(String(left), String(right));
      return sign * order || a.index - b.index;
    });
  }
}
