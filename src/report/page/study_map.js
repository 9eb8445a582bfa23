// Draws a map of an output, or of the pass rate, in colors over two parameters of a study.

/**
 * Returns the cells of the map along a parameter: {names, find, place}. `find` returns the cell of
 * a value, and `place` its position in units of cells. In a search, the cells are the intervals
 * into which the key's range is divided. Otherwise, each value has a cell; if there are many
 * numbers, cells are equal intervals.
 */
function stepsOfMap(column, { rows, isNumber, key }) {
  if (key) {
    const place = (value) => placeInRange(key, value) * key.tried.length;
    return {
      names: d3.range(key.tried.length).map((i) => shown(Number(valueInRange(key, (i + 0.5) / key.tried.length).toPrecision(3)))),
      find: (value) => (value === null ? -1 : Math.min(key.tried.length - 1, Math.max(0, Math.floor(place(value))))),
      place,
    };
  }
  const values = Array.from(new Set(rows.map((row) => row.cells[column.index])));
  if (!isNumber(column) || values.length <= 24) {
    if (isNumber(column)) values.sort(d3.ascending);
    const find = (value) => values.indexOf(value);
    return { names: values.map(shown), find, place: (value) => find(value) + 0.5 };
  }
  const [from, to] = d3.extent(values);
  const count = Math.min(16, Math.max(4, Math.round(Math.sqrt(rows.length / 12))));
  const place = (value) => (value - from) / (to - from) * count;
  const middle = (i) => from + (to - from) * (i + 0.5) / count;
  return {
    names: d3.range(count).map((i) => shown(Number(middle(i).toPrecision(3)))),
    find: (value) => (value === null ? -1 : Math.min(count - 1, Math.floor(place(value)))),
    place,
  };
}

/**
 * Draws a map whose cells show the mean of an output, the pass rate or, for a search, the lowest
 * robustness.
 */
function drawStudyMap(parent, { parameters, outputs, rows, isGood, isNumber, nameOf, search }) {
  const choices = choicesIn(parent);
  const list = parameters.map((column) => [column.index, nameOf(column)]);
  const across = choices.add('Across', 'map-x', list, list[0][0], draw);
  const up = choices.add('Up', 'map-y', list, list[1][0], draw);
  const searched = search && outputs.find(({ name }) => name === 'robustness');
  const of = choices.add('Color', 'map-of', [[-1, 'pass rate'], ...outputs.map((column) => [column.index, nameOf(column)])],
    searched ? searched.index : -1, draw);
  if (search) drawSigns(choices.node.append('div').attr('class', 'legend on-map'), search);
  const place = parent.append('div').attr('class', 'plots wide');
  if (search) parent.append('p').attr('class', 'hint').text('Each cell has the lowest robustness of its runs, whatever the other keys were; no run was in those that are empty.');
  draw();
  new ResizeObserver(draw).observe(place.node());

  function draw() {
    const x = parameters.find(({ index }) => index === across());
    const y = parameters.find(({ index }) => index === up());
    const output = outputs.find(({ index }) => index === of());
    const isLowest = Boolean(output) && output === searched;
    const keyOf = (column) => search && search.keys.find((key) => key.column === column.index);
    place.text('');
    const columns = stepsOfMap(x, { rows, isNumber, key: keyOf(x) });
    const lines = stepsOfMap(y, { rows, isNumber, key: keyOf(y) });
    const cells = d3.range(columns.names.length * lines.names.length).map(() => []);
    for (const row of rows) {
      const value = output ? row.cells[output.index] : Number(isGood(row));
      const [i, j] = [columns.find(row.cells[x.index]), lines.find(row.cells[y.index])];
      if (value !== null && i >= 0 && j >= 0) cells[j * columns.names.length + i].push(value);
    }
    const values = cells.map((own) => (!own.length ? null : isLowest ? d3.min(own) : d3.mean(own)));
    const text = (value) => (output ? shown(Number(value.toPrecision(3))) : percent(value, 0));
    const what = !output ? 'Pass rate' : `${isLowest ? 'Lowest' : 'Mean of'} ${nameOf(output)}`;
    drawMapCells(place, {
      title: `${what} over ${nameOf(x)} and ${nameOf(y)}`, nameX: nameOf(x), nameY: nameOf(y), columns, lines, values, text,
      counts: cells.map(({ length }) => length),
      scale: isLowest ? colorsOfRobustness(values) : colorsFrom(output ? d3.extent(values.filter((value) => value !== null)) : [0, 1]),
      marks: (search ? marksOfSearch(search) : []).map(({ kind, at }) => ({ kind, x: at[x.name], y: at[y.name] })),
    });
  }
}

/**
 * Returns a color scale from dark to bright, as {color, at}. `color` gives the color of a value,
 * and `at` the value at a fraction of the scale.
 */
function colorsFrom([least, most]) {
  return {
    color: (value) => d3.interpolateViridis(most > least ? (value - least) / (most - least) : 0.5),
    at: (share) => least + share * (most - least),
  };
}

function drawMapCells(place, { title, nameX, nameY, columns, lines, values, text, counts, scale, marks }) {
  const { svg, width, height } = figureIn(place, title, '', 'map', Math.min(520, 100 + 34 * lines.names.length));
  const longest = d3.max(lines.names, (name) => name.length);
  const margin = { left: Math.min(0.4 * width, 28 + 7 * longest), right: 8, top: 24, bottom: 84 };
  const wide = (width - margin.left - margin.right) / columns.names.length;
  const high = (height - margin.top - margin.bottom) / lines.names.length;
  const every = Math.ceil(46 / wide);
  const cut = (name, room) => (name.length * 7 > room ? `${name.slice(0, Math.max(1, Math.floor(room / 7) - 1))}…` : name);
  svg.append('text').attr('class', 'axis-name').attr('x', 8).attr('y', 14).text(`↑ ${nameY}`);
  svg.append('text').attr('class', 'axis-name').attr('text-anchor', 'end').attr('x', width - margin.right)
    .attr('y', height - 44).text(`${nameX} →`);
  columns.names.forEach((name, i) => {
    if (i % every) return;
    svg.append('text').attr('class', 'bar-name').attr('text-anchor', 'middle').attr('x', margin.left + (i + 0.5) * wide)
      .attr('y', height - margin.bottom + 16).text(cut(name, every * wide)).append('title').text(name);
  });
  lines.names.forEach((name, j) => {
    svg.append('text').attr('class', 'bar-name').attr('text-anchor', 'end').attr('x', margin.left - 8)
      .attr('y', height - margin.bottom - (j + 0.5) * high + 4).text(cut(name, margin.left - 16)).append('title').text(name);
  });
  values.forEach((value, cell) => {
    const [i, j] = [cell % columns.names.length, Math.floor(cell / columns.names.length)];
    const rect = svg.append('rect').attr('class', value === null ? 'cell none' : 'cell')
      .attr('x', margin.left + i * wide).attr('y', height - margin.bottom - (j + 1) * high)
      .attr('width', Math.max(1, wide - 1)).attr('height', Math.max(1, high - 1));
    if (value !== null) rect.style('fill', scale.color(value));
    rect.append('title').text(value === null ? 'no row' : `${columns.names[i]}, ${lines.names[j]}: ${text(value)}, ${counts[cell]} rows`);
  });
  for (const mark of marks) {
    svg.append('path').attr('class', `sign-of ${mark.kind} on-map`).attr('d', signOfPoint(mark.kind))
      .attr('transform', `translate(${margin.left + columns.place(mark.x) * wide} ${height - margin.bottom - lines.place(mark.y) * high})`);
  }
  // Draws the color bar of the color map.
  const bar = svg.append('g').attr('transform', `translate(${margin.left} ${height - 30})`);
  const steps = 40;
  const length = Math.min(220, width - margin.left - 60);
  for (const i of d3.range(steps)) {
    bar.append('rect').attr('x', i * length / steps).attr('width', length / steps + 0.5).attr('height', 10)
      .style('fill', scale.color(scale.at(i / (steps - 1))));
  }
  bar.append('text').attr('class', 'bar-name').attr('y', 25).text(text(scale.at(0)));
  bar.append('text').attr('class', 'bar-name').attr('y', 25).attr('x', length).attr('text-anchor', 'end').text(text(scale.at(1)));
}
