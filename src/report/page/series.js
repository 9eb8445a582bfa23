// What was measured over time, one chart below the other, with one cursor.

const QUANTITIES = [
  { name: 'cross_track', title: 'Cross-track error', unit: 'm', digits: 4, note: 'positive: left of the path' },
  { name: 'heading_error', title: 'Heading error', unit: 'rad', digits: 4, note: 'positive: turned to the left' },
  { name: 'steering', title: 'Steering angle', unit: 'rad', digits: 4, asked: 'steering_command', note: 'dashed: commanded' },
  { name: 'speed', title: 'Speed', unit: 'm/s', digits: 3 },
  { name: 'yaw_rate', title: 'Yaw rate', unit: 'rad/s', digits: 4 },
  { name: 'lateral_acceleration', title: 'Lateral acceleration', unit: 'm/s²', digits: 3 },
  { name: 'clearance', title: 'Clearance from obstacles', unit: 'm', digits: 3 },
];

/** The moments of all logs, and for each log its row at each of them or none. */
function commonTimes() {
  const times = Array.from(new Set(tracks.flatMap((track) => track.log.t))).sort(d3.ascending);
  const rows = tracks.map((track) => {
    const row = new Map(track.log.t.map((t, i) => [t, i]));
    return times.map((t) => row.get(t));
  });
  return { times, rows };
}

/** Round numbers, about so many pixels apart. */
function ticksEvery(pixels, name) {
  return (from, to, length) => d3.ticks(from, to, Math.max(2, Math.round(length / pixels)))
    .map((value) => ({ v: value, label: name(value) }));
}

function drawSeries(parent) {
  const list = parent.append('div').attr('class', 'series');
  const { times, rows } = commonTimes();
  const charts = [];
  let busy = false;

  /** Others follow, unless it is they who called. */
  const together = (act) => {
    if (busy) return;
    busy = true;
    try { act(); } finally { busy = false; }
  };

  const look = (lines) => ({
    colors: lines.map((line) => colourOf(`--track-${line.track.colour}`)),
    axisLineColor: colourOf('--line'),
    gridLineColor: colourOf('--grid'),
  });

  for (const quantity of QUANTITIES.filter((q) => tracks.some((track) => track.log[q.name]))) {
    const own = tracks.filter((track) => track.log[quantity.name]);
    // What was asked lies below what was done.
    const lines = [
      ...(quantity.asked ? own.map((track) => ({ track, name: quantity.asked, asked: true })) : []),
      ...own.map((track) => ({ track, name: quantity.name, asked: false })),
    ];
    const figure = list.append('figure').attr('class', 'chart panel').attr('data-quantity', quantity.name);
    const caption = figure.append('figcaption');
    const title = caption.append('span').attr('class', 'title').text(quantity.title);
    title.append('span').text(` [${quantity.unit}]`);
    if (quantity.note) title.append('span').attr('class', 'note').text(`  ${quantity.note}`);
    const group = caption.append('span').attr('class', 'readouts');
    const readouts = own.map((track) => {
      const readout = group.append('span').attr('class', 'readout').attr('data-track', track.label)
        .attr('title', track.label);
      readout.append('span').attr('class', 'dot').style('color', track.css);
      return { track, readout, text: readout.append('span') };
    });
    const plot = figure.append('div').attr('class', 'plot');
    const table = times.map((t, i) => [t, ...lines.map(({ track, name }) => {
      const row = rows[track.id][i];
      return row === undefined ? null : track.log[name][row];
    })]);
    const labels = lines.map(({ track, asked }) => `${track.id} ${track.label}${asked ? ' commanded' : ''}`);
    const { touchstart, touchmove, touchend, ...mouse } = Dygraph.defaultInteractionModel;
    const graph = new Dygraph(plot.append('div').style('width', '100%').style('height', '100%').node(), table, {
      labels: ['t', ...labels],
      series: Object.fromEntries(lines.map(({ asked }, i) => [labels[i],
        asked ? { strokePattern: [5, 4], strokeWidth: 1.2 } : { strokeWidth: 1.6 }])),
      legend: 'never',
      connectSeparatedPoints: true,
      hideOverlayOnMouseOut: false,
      highlightCircleSize: 3,
      yRangePad: 8,
      interactionModel: mouse,
      axes: {
        x: { ticker: ticksEvery(80, (value) => `${shown(value)} s`), axisLabelWidth: 60 },
        y: { ticker: ticksEvery(30, shown), axisLabelWidth: 52 },
      },
      ...look(lines),
      highlightCallback: (event, time) => together(() => setTime(time, 'series')),
      drawCallback: (drawn, first) => {
        if (first) return;
        together(() => charts.forEach((chart) => {
          if (chart.graph !== drawn) chart.graph.updateOptions({ dateWindow: drawn.xAxisRange() });
        }));
        placeCursors(now);
      },
    });
    const cursor = plot.append('div').attr('class', 'cursor');
    // A finger along the chart moves the cursor; the page scrolls up and down under it.
    plot.on('pointermove pointerdown', () => {
      const event = d3.event;
      if (event.pointerType === 'mouse') return;
      const at = graph.eventToDomCoords(event)[0];
      setTime(graph.toDataXCoord(at), 'series');
    });
    charts.push({ graph, cursor, plot, lines, readouts, quantity });
  }

  function placeCursors(time) {
    for (const { graph, cursor } of charts) {
      const area = graph.getArea();
      const x = graph.toDomXCoord(time);
      const inside = x >= area.x - 0.5 && x <= area.x + area.w + 0.5;
      cursor.style('display', inside ? null : 'none')
        .style('left', `${x}px`).style('height', `${area.y + area.h}px`);
    }
  }

  bus.on('time.series', (time) => {
    const row = Math.max(0, d3.bisectRight(times, time + 1e-9) - 1);
    const was = busy;
    busy = true;
    for (const { graph } of charts) graph.setSelection(row);
    busy = was;
    placeCursors(time);
    for (const { readouts, quantity } of charts) {
      for (const { track, text } of readouts) {
        const value = valueAt(track, quantity.name, time);
        const asked = quantity.asked ? valueAt(track, quantity.asked, time) : null;
        const fixed = (number) => (number === null ? '–'
          : number.toFixed(quantity.digits).replace(/^-(?=[0.]*$)/, '').replace('-', '−'));
        text.text(fixed(value) + (asked === null ? '' : ` (${fixed(asked)})`));
      }
    }
  });
  bus.on('visibility.series', () => {
    for (const { graph, lines, readouts } of charts) {
      together(() => graph.setVisibility(Object.fromEntries(lines.map(({ track }, i) => [i, track.visible]))));
      for (const { track, readout } of readouts) readout.style('display', track.visible ? null : 'none');
    }
    setTime(now);
  });
  bus.on('scheme.series', () => {
    for (const { graph, lines } of charts) together(() => graph.updateOptions(look(lines)));
    setTime(now);
  });
  // The charts' own width follows late; the cursor stands right after it.
  new ResizeObserver(() => {
    for (const { graph } of charts) graph.resize();
    placeCursors(now);
  }).observe(list.node());
}
