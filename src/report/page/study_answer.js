// Draws the summary at the top of a study's page, with one line per output.

// Texts for the result of a bisection, by the status of its row.
const BISECTED = {
  found: 'passes up to', passes_at_to: 'passes in all of its range, up to', fails_at_from: 'fails in all of its range',
};

/**
 * Returns the varied parameters of a row as text, such as "control.distance = 2 m, mission.speed =
 * 5 m/s".
 */
function pointText(row, varied) {
  return varied.map(({ name, unit, index }) => `${name} = ${shown(row.cells[index])}${unit ? ` ${unit}` : ''}`).join(', ');
}

function drawStudyAnswer(parent, { study, outputs, varied, rows, status }) {
  const MOST = 4;
  const list = parent.append('ul').attr('class', 'panel found');
  const say = (name, size, text) => {
    const line = list.append('li');
    line.append('span').text(name);
    line.append('strong').text(size);
    line.append('span').attr('class', 'hint').text(text);
  };
  const unitOf = ({ unit }) => (unit ? ` ${unit}` : '');
  for (const output of outputs.slice(0, MOST)) {
    const there = rows.filter((row) => typeof row.cells[output.index] === 'number')
      .sort((a, b) => a.cells[output.index] - b.cells[output.index]);
    if (!there.length) continue;
    const [least, most] = [there[0], there[there.length - 1]];
    const value = (row) => brief(row.cells[output.index]);
    if (output.name === study.bisected && there.length === 1) {
      say(output.label, `${value(least)}${unitOf(output)}`, BISECTED[least.cells[status.index]] || statusText(String(least.cells[status.index])));
    } else if (there.length === 1 || value(least) === value(most)) {
      say(output.label, `${value(least)}${unitOf(output)}`, there.length === 1 ? '' : 'in all rows');
    } else {
      say(output.label, `${value(least)} to ${value(most)}${unitOf(output)}`,
        varied.length ? `smallest with ${pointText(least, varied)}; largest with ${pointText(most, varied)}` : '');
    }
  }
}
