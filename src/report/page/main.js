// Puts the page together.

function drawDrive() {
  const drive = section('drive', tracks.length ? 'The drive' : 'The map');
  drawLegend(drive);
  if (tracks.length) {
    drive.append('p').attr('class', 'hint')
      .text('Point at a chart to move the cars. Drag in a chart to zoom in, double click for all of it.');
  }
  const grid = drive.append('div').attr('class', 'drive');
  const scene = grid.append('div').attr('class', 'scene');
  drawFilms(scene);
  const panel = scene.append('div').attr('class', 'panel map-panel');
  drawMap(panel);
  if (tracks.length) {
    drawClock(panel);
    const charts = grid.append('div').attr('class', 'all-charts');
    if (pairs.some((pair) => pair.curve)) {
      charts.append('h3').text('Differences over the station');
      drawDifferenceCharts(charts);
      charts.append('h3').text('Each drive over time');
    }
    drawSeries(charts);
  }
  setTime(0);
}

if (data.study) {
  drawStudy(data.study);
} else {
  drawHead();
  drawHeadline();
  drawDifferences();
  drawDrive();
  if (tracks.length) {
    drawNumbers(section('numbers', 'Metrics'), tracks);
    const plants = runs.flatMap((run) => run.between.map(({ plants, numbers }) => ({
      label: `${runs.length > 1 ? `${run.name}: ` : ''}${plants.join(' – ')}`, numbers,
    })));
    if (plants.length) drawNumbers(section('between', 'How far the plants part, at equal station'), plants);
  }
  drawExpectations();
  drawScenarios();
}
drawFoot();
