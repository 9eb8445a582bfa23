// Draws a column of charts with a common cursor at the current time of the page.

// Titles and readouts of the charts are ordinary HTML elements. The legend of the chart library
// dygraphs is not used, because it sets a style attribute, which the page's Content-Security-Policy
// forbids.
Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);

// Keeps half the height of an axis label free above the chart. If a label would begin above the
// chart, dygraphs moves the label down, away from its grid line.
Dygraph.PLUGINS.push(class {
  activate() {
    const layout = (event) => {
      event.reserveSpaceTop(Math.ceil(event.dygraph.getOptionForAxis('axisLabelFontSize', 'y') / 2));
    };
    return { layout };
  }
});

/** Returns a function that chooses ticks at round values, about `pixels` apart. */
function ticksEvery(pixels, name) {
  return (from, to, length) => d3.ticks(from, to, Math.max(2, Math.round(length / pixels)))
    .map((value) => ({ v: value, label: name(value) }));
}

// Maps each plot to its dygraphs object, so that elements can be placed over the plot.
const graphs = new WeakMap();

function fixed(number, digits) {
  if (number === null) return '–';
  return number.toFixed(digits).replace(/^-(?=[0.]*$)/, '').replace('-', '−');
}

/**
 * Returns the limits that are near the lines, and the range of values that contains these limits
 * and the lines. The range is null if the default range suffices. Values after a line's `until` are
 * not valid results and do not affect the range.
 */
function limitsToDraw(lines, limits, places) {
  const isCut = lines.some(({ until }) => until !== undefined);
  const values = lines.flatMap(({ values: own, until }) => (until === undefined ? own : own.filter((_, i) => places[i] <= until)))
    .filter((value) => value !== null);
  if (!values.length || (!limits.length && !isCut)) return { limits: [], range: null };
  const reach = d3.max(values, Math.abs);
  const near = limits.filter((limit) => Math.abs(limit) <= 2 * reach
    && (limit >= 0 ? d3.max(values) > 0.5 * limit : d3.min(values) < 0.5 * limit));
  if (!near.length && !isCut) return { limits: near, range: null };
  const [low, high] = d3.extent([...values, ...near]);
  const room = 0.08 * (high - low) || 1e-6;
  return { limits: near, range: [low - room, high + room] };
}

/** Returns a description of a chart for screen readers, which gives the range of each line. */
function chartText({ title, unit, lines, limits, axis }) {
  const ranges = lines.filter(({ pattern }) => !pattern || lines.every((line) => line.pattern)).map(({ label, values }) => {
    const [low, high] = d3.extent(values.filter((value) => value !== null));
    return `${label} from ${brief(low)} to ${brief(high)} ${unit}`;
  });
  const [first, last] = d3.extent(axis.values);
  return `${title} over ${brief(first)} to ${brief(last)} ${axis.unit}: ${ranges.join(', ')}${limits.length ? `; limits ${limits.map(brief).join(', ')}` : ''}.`;
}

/**
 * Draws charts into `list`; `key` distinguishes them from other groups of charts. `axis` is
 * {values, unit, at, timeOf}: the positions of the rows along the axis, and functions that convert
 * a time to a position and back. A chart is {name, title, unit, note, lines, limits, readouts}. A
 * line is {label, color, tracks, values, pattern, width, until}. A readout is {label, tracks, sign,
 * text}, where the function `text` returns the value at a time. Each limit is drawn as a horizontal
 * line.
 */
function drawCharts(list, key, axis, charts) {
  const drawn = [];
  let busy = false;
  const isShown = ({ tracks: own }) => own.every((track) => track.visible);

  /** Runs `act`, unless the call was caused by the update of another chart. */
  const together = (act) => {
    if (busy) return;
    busy = true;
    try { act(); } finally { busy = false; }
  };

  const look = (lines) => ({
    colors: lines.map((line) => cssColor(`--track-${line.color}`)),
    axisLineColor: cssColor('--line'),
    gridLineColor: cssColor('--grid'),
  });

  for (const { name, title, unit, note, lines, readouts, limits: all = [] } of charts) {
    let { limits, range } = limitsToDraw(lines, all, axis.values);
    const far = all.filter((limit) => !limits.includes(limit) && limit > 0);
    const figure = list.append('figure').attr('class', 'chart panel').attr('data-quantity', name);
    const caption = figure.append('figcaption');
    const heading = caption.append('span').attr('class', 'title').text(title);
    heading.append('span').text(` [${unit}]`);
    const notes = [note, limits.length && 'dotted: limit', far.length && `limit ${far.map(brief).join(', ')}, beyond the chart`];
    if (notes.some(Boolean)) heading.append('span').attr('class', 'note').text(`  ${notes.filter(Boolean).join('; ')}`);
    const group = caption.append('span').attr('class', 'readouts');
    const told = readouts.map((of) => {
      const readout = group.append('span').attr('class', 'readout').attr('data-track', of.label)
        .attr('title', of.label);
      of.sign(readout);
      return { of, readout, text: readout.append('span') };
    });
    const plot = figure.append('div').attr('class', 'plot').attr('role', 'img')
      .attr('aria-label', chartText({ title, unit, lines, limits, axis }));
    const labels = lines.map(({ label }, i) => `${i} ${label}`);
    const { touchstart, touchmove, touchend, ...mouse } = Dygraph.defaultInteractionModel;
    const table = () => axis.values.map((value, i) => [value, ...lines.map((line) => line.values[i])]);
    const graph = new Dygraph(plot.append('div').style('width', '100%').style('height', '100%').node(), table(), {
      labels: ['at', ...labels],
      series: Object.fromEntries(lines.map(({ pattern, width }, i) => [labels[i],
        { strokePattern: pattern || null, strokeWidth: width }])),
      connectSeparatedPoints: true,
      hideOverlayOnMouseOut: false,
      highlightCircleSize: 3,
      yRangePad: 8,
      rightGap: 32,
      ...(range ? { valueRange: range } : {}),
      underlayCallback: (canvas, area, dygraph) => {
        canvas.save();
        // Grays out the time after all cars have collided or rolled over, because there are no
        // valid results.
        if (lines.length && lines.every(({ until }) => until !== undefined)) {
          const x = dygraph.toDomXCoord(d3.max(lines, ({ until }) => until));
          canvas.fillStyle = cssColor('--grid');
          canvas.fillRect(Math.max(x, area.x), area.y, Math.max(0, area.x + area.w - Math.max(x, area.x)), area.h);
        }
        canvas.setLineDash([6, 3]);
        for (const { until, color } of lines.filter((line) => line.until !== undefined)) {
          const x = dygraph.toDomXCoord(until);
          canvas.strokeStyle = cssColor(`--track-${color}`);
          canvas.beginPath();
          canvas.moveTo(x, area.y);
          canvas.lineTo(x, area.y + area.h);
          canvas.stroke();
        }
        canvas.strokeStyle = cssColor('--bad');
        canvas.setLineDash([2, 3]);
        for (const limit of limits) {
          const y = dygraph.toDomYCoord(limit);
          if (y < area.y || y > area.y + area.h) continue;
          canvas.beginPath();
          canvas.moveTo(area.x, y);
          canvas.lineTo(area.x + area.w, y);
          canvas.stroke();
        }
        canvas.restore();
      },
      interactionModel: mouse,
      axes: {
        x: { ticker: ticksEvery(80, (value) => `${shown(value)} ${axis.unit}`), axisLabelWidth: 60 },
        y: { ticker: ticksEvery(30, shown), axisLabelWidth: 52 },
      },
      ...look(lines),
      highlightCallback: (event, place) => together(() => setTime(axis.timeOf(place), key)),
      drawCallback: (own, first) => {
        if (first) return;
        together(() => drawn.forEach((chart) => {
          if (chart.graph !== own) chart.graph.updateOptions({ dateWindow: own.isZoomed('x') ? own.xAxisRange() : null });
        }));
        placeCursors(now);
      },
    });
    const cursor = plot.append('div').attr('class', 'cursor');
    // A horizontal touch gesture moves the cursor, and a vertical gesture scrolls the page.
    plot.on('pointermove pointerdown', () => {
      const event = d3.event;
      if (event.pointerType === 'mouse') return;
      const at = graph.eventToDomCoords(event)[0];
      setTime(axis.timeOf(graph.toDataXCoord(at)), key);
    });
    const refill = () => {
      ({ limits, range } = limitsToDraw(lines, all, axis.values));
      graph.updateOptions({ file: table(), valueRange: range });
    };
    graphs.set(plot.node(), graph);
    drawn.push({ graph, cursor, lines, told, refill });
  }

  function placeCursors(time) {
    for (const { graph, cursor } of drawn) {
      const area = graph.getArea();
      const x = graph.toDomXCoord(axis.at(time));
      const inside = x >= area.x - 0.5 && x <= area.x + area.w + 0.5;
      cursor.style('display', inside ? null : 'none')
        .style('left', `${x}px`).style('height', `${area.y + area.h}px`);
    }
  }

  bus.on(`time.${key}`, (time) => {
    const row = Math.max(0, d3.bisectRight(axis.values, axis.at(time) + 1e-9) - 1);
    const was = busy;
    busy = true;
    for (const { graph } of drawn) graph.setSelection(row);
    busy = was;
    placeCursors(time);
    for (const { told } of drawn) {
      for (const { of, text } of told) text.text(of.text(time));
    }
  });
  bus.on(`rows.${key}_charts`, () => together(() => drawn.forEach(({ refill }) => refill())));
  bus.on(`visibility.${key}`, () => {
    for (const { graph, lines, told } of drawn) {
      together(() => graph.setVisibility(Object.fromEntries(lines.map((line, i) => [i, isShown(line)]))));
      for (const { of, readout } of told) readout.style('display', isShown(of) ? null : 'none');
    }
    setTime(now);
  });
  bus.on(`scheme.${key}`, () => {
    for (const { graph, lines } of drawn) together(() => graph.updateOptions(look(lines)));
    setTime(now);
  });
  // After a change of the page's width, the charts adapt with a delay, so the cursor is then placed
  // again.
  new ResizeObserver(() => {
    for (const { graph } of drawn) graph.resize();
    placeCursors(now);
  }).observe(list.node());
}
