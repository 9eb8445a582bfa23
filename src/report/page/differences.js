// Draws the differences between runs at equal stations, as a table and as curves.

const DIFFERENCES = [
  { name: 'position', title: 'Distance', unit: 'm', digits: 4 },
  { name: 'heading', title: 'Heading difference', unit: 'rad', digits: 4, note: 'positive: second further left' },
  { name: 'yaw_rate', title: 'Yaw rate difference', unit: 'rad/s', digits: 4 },
  { name: 'steering', title: 'Steering difference', unit: 'rad', digits: 4 },
];

function nameOfPair(first, second) {
  const [one, other] = [runs[first.run].name, runs[second.run].name];
  if (first.run !== second.run) {
    return first.plant === second.plant ? `${first.plant}: ${one} – ${other}`
      : `${first.label} – ${second.label}`;
  }
  return `${runs.length > 1 ? `${one}: ` : ''}${first.plant} – ${second.plant}`;
}

/**
 * The compared pairs, with the style of each pair's curve. The color is that of the second plant,
 * and pairs with equal colors have different dashes.
 */
const pairs = (() => {
  const times = new Map();
  const patterns = [null, [6, 3], [2, 3], [9, 3, 2, 3]];
  const trackOf = ({ run, plant }) => tracks.find((track) => track.run === run && track.plant === plant);
  return ((data.comparison || {}).pairs || []).map((pair) => {
    const [first, second] = [trackOf(pair.first), trackOf(pair.second)];
    const before = times.get(second) || 0;
    times.set(second, before + 1);
    return {
      ...pair, first, second, label: nameOfPair(first, second), pattern: patterns[before % patterns.length],
    };
  });
})();

function signOfPair(parent, pair) {
  parent.append('svg').attr('class', 'pair-sign').attr('width', 22).attr('height', 8).append('path')
    .attr('d', 'M0 4h22').style('stroke', pair.second.css)
    .attr('stroke-dasharray', pair.pattern && pair.pattern.join(' '));
}

/**
 * Draws a table with a row for each pair, which has the sizes and places of the differences, and
 * the tolerances.
 */
function drawDifferences() {
  // For the plants of a single run, the section `between` of the page already shows the
  // differences.
  if (!pairs.length || (runs.length === 1 && !pairs.some((pair) => pair.tolerances))) return;
  const made = section('differences', 'Differences at equal station');
  const table = made.append('div').attr('class', 'panel scroll').append('table');
  const head = table.append('thead').append('tr');
  head.append('th').attr('class', 'text').text('Drives');
  for (const { title, unit } of DIFFERENCES) withUnit(head.append('th'), title, unit);
  const body = table.append('tbody');
  for (const pair of pairs) {
    const line = body.append('tr').attr('data-pair', pair.label);
    const name = line.append('th').attr('scope', 'row');
    signOfPair(name, pair);
    name.append('span').text(pair.label);
    if (!pair.curve) {
      line.append('td').attr('class', 'text hint').attr('colspan', DIFFERENCES.length)
        .text('station ranges do not overlap');
      continue;
    }
    for (const { name: quantity } of DIFFERENCES) {
      const value = (what) => valueOf(pair.numbers, `${quantity}.${what}`);
      const most = pair.tolerances ? pair.tolerances[`${quantity}_max`] : undefined;
      const kept = most === undefined || value('max') <= most;
      const cell = line.append('td').attr('data-quantity', quantity);
      cell.append('span').attr('class', kept ? 'most' : 'most bad').text(shown(value('max')));
      if (most !== undefined) {
        cell.append('span').attr('class', kept ? 'good' : 'bad').text(`${kept ? '✓' : '✗'} at most ${shown(most)}`);
      }
      cell.append('span').attr('class', 'where').text(`at ${brief(value('max_s'))} m, ${brief(value('max_t'))} s`);
      cell.append('span').attr('class', 'where').text(`rms ${shown(value('rms'))}`);
    }
  }
}

function drawDifferenceCharts(parent) {
  const own = pairs.filter((pair) => pair.curve);
  if (!own.length) return;
  const values = Array.from(new Set(own.flatMap((pair) => pair.curve.s))).sort(d3.ascending);
  const spread = ({ curve }, name) => values.map((at) => (
    at < curve.s[0] || at > curve.s[curve.s.length - 1] ? null : interpolated(curve.s, curve[name], at)));
  // All pairs use the conversion between station and time of the first pair, since the times of the
  // pairs are nearly equal.
  const { s, t } = own[0].curve;
  const axis = { values, unit: 'm', at: (time) => interpolated(t, s, time), timeOf: (at) => interpolated(s, t, at) };
  drawCharts(parent.append('div').attr('class', 'series'), 'differences', axis, DIFFERENCES.map((quantity) => ({
    ...quantity,
    name: `difference_${quantity.name}`,
    lines: own.map((pair) => ({
      label: pair.label, color: pair.second.color, tracks: [pair.first, pair.second],
      values: spread(pair, quantity.name), pattern: pair.pattern, width: 1.6,
    })),
    readouts: own.map((pair) => ({
      label: pair.label,
      tracks: [pair.first, pair.second],
      sign: (readout) => signOfPair(readout, pair),
      text: (time) => fixed(interpolated(pair.curve.s, pair.curve[quantity.name], axis.at(time)), quantity.digits),
    })),
  })));
}
