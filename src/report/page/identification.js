// Shows the result of an identification: the estimated parameters, their accuracy, and the model
// before and after the fit.

const parameterStatus = {
  identified: '', at_lower_bound: 'at its lower bound', at_upper_bound: 'at its upper bound', not_identified: 'not identified', unfinished: 'not finished',
};

function drawIdentification(found) {
  drawIdentificationHead(found);
  drawEstimates(section('estimates', 'Parameters'), found);
  drawRecordTable(section('records', 'Against the records'), found);
  if (found.correlation.names.length > 1) drawCorrelation(section('correlation', 'Correlation of the estimates'), found.correlation);
  drawResiduals(section('residuals', `Residuals on ${found.plant}`), found);
}

function drawIdentificationHead(found) {
  const header = root.append('header');
  const heading = header.append('div').attr('class', 'heading');
  heading.append('h1').text(found.name);
  const known = found.parameters.filter(({ status }) => status === 'identified').length;
  heading.append('span').attr('class', found.complete ? 'badge plain' : 'badge bad').attr('id', 'verdict')
    .text(found.complete ? `${known} of ${found.parameters.length} parameters identified` : 'interrupted: the best so far');
  const held = found.records.filter((record) => record.held_out);
  facts(header, [
    `plant ${found.plant}`,
    `${found.windows.count} windows of ${brief(found.windows.horizon_s)} s in ${found.records.length - held.length} records`,
    held.length > 0 && `held out: ${held.map(({ name }) => name).join(', ')}`,
    `cost ${brief(found.cost.start)} → ${brief(found.cost.fitted)} (from each start ${found.cost.of_starts.map((cost) => brief(cost)).join(', ')})`, `${found.evaluations} evaluations`,
    `Trackbed ${found.versions.trackbed}`, found.versions.physics, found.versions.optimizer,
  ]);
}

/** Draws an estimate between its bounds, with an error bar of two standard errors to each side. */
function drawRange(cell, { from, to, start, value, standard_error: error }) {
  const width = 150;
  const x = d3.scaleLinear().domain([from, to]).range([4, width - 4]).clamp(true);
  const label = value === null ? 'not estimated' : `estimate ${brief(value)} between ${brief(from)} and ${brief(to)}`;
  const svg = cell.append('svg').attr('class', 'range').attr('width', width).attr('height', 18).attr('role', 'img').attr('aria-label', label);
  svg.append('path').attr('class', 'bounds').attr('d', `M${x(from)} 4v10M${x(from)} 9H${x(to)}M${x(to)} 4v10`);
  svg.append('path').attr('class', 'start').attr('d', `M${x(start)} 4v10`);
  if (value === null) return;
  if (error !== null) svg.append('path').attr('class', 'error').attr('d', `M${x(value - 2 * error)} 9H${x(value + 2 * error)}`);
  svg.append('circle').attr('class', 'estimate').attr('cx', x(value)).attr('cy', 9).attr('r', 4);
}

function drawEstimates(parent, { parameters }) {
  parent.append('p').attr('class', 'hint')
    .text('Between its bounds: the start (line), the estimate (dot) and two standard errors to both sides.');
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Parameter');
  for (const name of ['Start', 'Estimate', 'Standard error']) head.append('th').text(name);
  for (const name of ['Within its bounds', 'Remark']) head.append('th').attr('class', 'text').text(name);
  const body = table.append('tbody');
  for (const parameter of parameters) {
    const line = body.append('tr').attr('data-parameter', parameter.name);
    line.append('th').attr('scope', 'row').text(parameter.name);
    line.append('td').text(brief(parameter.start));
    line.append('td').text(parameter.value === null ? '–' : brief(parameter.value));
    line.append('td').text(parameter.standard_error === null ? '–' : brief(parameter.standard_error));
    drawRange(line.append('td').attr('class', 'text'), parameter);
    line.append('td').attr('class', 'text remark')
      .text([parameterStatus[parameter.status], parameter.remark].filter(Boolean).join(': '));
  }
}

function drawRecordTable(parent, { records, windows }) {
  const after = `after ${brief(windows.horizon_s)} s`;
  parent.append('p').attr('class', 'hint')
    .text('Before → after the fit. Yaw rate: root mean square of the error over that of the recorded one, over the whole record.');
  const table = parent.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  for (const name of ['Record', '', 'Plant']) head.append('th').attr('class', 'text').text(name);
  for (const name of ['Yaw rate', `Position ${after}, median [m]`, `90 % [m]`]) head.append('th').text(name);
  const body = table.append('tbody');
  const arrow = (start, fitted) => `${start === null || start === undefined ? '–' : brief(start)} → ${fitted === null || fitted === undefined ? '–' : brief(fitted)}`;
  const windowOf = (of) => (of.windows.find(({ horizon_s: horizon }) => horizon === windows.horizon_s) || {});
  for (const record of records) {
    for (const [plant, { start, fitted }] of Object.entries(record.plants)) {
      const line = body.append('tr').attr('data-record', record.name);
      line.append('td').attr('class', 'text').text(record.name);
      line.append('td').attr('class', 'text').text(record.held_out ? 'held out' : 'fitted');
      line.append('td').attr('class', 'text').text(plant);
      line.append('td').text(arrow(start.yaw_rate_relative_rms, fitted.yaw_rate_relative_rms));
      line.append('td').text(arrow(windowOf(start).position_median_m, windowOf(fitted).position_median_m));
      line.append('td').text(arrow(windowOf(start).position_p90_m, windowOf(fitted).position_p90_m));
    }
  }
}

function drawCorrelation(parent, { names, matrix }) {
  const table = parent.append('div').attr('class', 'panel scroll').append('table').attr('class', 'correlation');
  const head = table.append('thead').append('tr');
  head.append('th');
  for (const name of names) head.append('th').text(name);
  const body = table.append('tbody');
  matrix.forEach((row, i) => {
    const line = body.append('tr');
    line.append('th').attr('scope', 'row').text(names[i]);
    row.forEach((value, j) => {
      line.append('td').attr('class', i !== j && Math.abs(value) > 0.95 ? 'bad' : null).text(i === j ? '' : fixed(value, 2));
    });
  });
}

function drawResiduals(parent, { records }) {
  const choice = choicesIn(parent);
  const list = parent.append('div').attr('class', 'all-charts');
  let chosen = () => 0;
  function draw() {
    list.text('');
    const { residuals } = records[chosen()];
    const times = residuals.t_s;
    duration = times[times.length - 1];
    const quantity = (name, title, unit, column) => {
      const of = (kind) => residuals[`${column}_${kind}_${unit === 'rad/s' ? 'radps' : 'mps2'}`];
      const line = (label, color, values, pattern) => ({ label, color, values, pattern, tracks: [], width: 1.5 });
      const difference = (kind) => of(kind).map((value, i) => value - of('recorded')[i]);
      const readout = ({ label, color, values }) => ({
        label,
        tracks: [],
        sign: (node) => node.append('span').attr('class', 'dot').style('color', `var(--track-${color})`),
        text: (time) => fixed(interpolated(times, values, time), 3),
      });
      const lines = [line('recorded', 2, of('recorded')), line('start', 0, of('start'), [4, 3]), line('fitted', 1, of('fitted'))];
      const errors = [line('start', 0, difference('start'), [4, 3]), line('fitted', 1, difference('fitted'))];
      return [
        { name, title, unit, lines, readouts: lines.map(readout), note: 'green: recorded, dashed: start, other: fitted' },
        { name: `${name}_error`, title: `${title}, less the recorded one`, unit, lines: errors, readouts: errors.map(readout) },
      ];
    };
    if (!times.length) {
      list.append('p').text('The fitted plant is not among those of this scenario.');
      return;
    }
    drawCharts(list, 'residuals', { values: times, unit: 's', at: (time) => time, timeOf: (place) => place }, [
      ...quantity('yaw_rate', 'Yaw rate', 'rad/s', 'yaw_rate'),
      ...quantity('lateral_acceleration', 'Lateral acceleration', 'm/s²', 'lateral_acceleration'),
    ]);
    setTime(0);
  }
  chosen = choice.add('Record', 'record', records.map(({ name, held_out: held }, i) => [i, held ? `${name} (held out)` : name]), 0, draw);
  draw();
}
