// Draws all parts of a report page in order.

function drawDrive() {
  const drive = section('drive', tracks.length ? 'Run' : 'Map');
  drawLegend(drive);
  if (tracks.length) {
    drive.append('p').attr('class', 'hint')
      .text('Hover over a chart to move the cars. Drag in a chart to zoom, double-click to reset. All times count from the start of the run.');
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
      charts.append('h3').text('Differences over station');
      drawDifferenceCharts(charts);
      charts.append('h3').text('Plants over time');
    }
    drawSeries(charts);
  }
  setTime(keyMoment);
}

if (data.study) {
  drawStudy(data.study);
} else if (data.identification) {
  drawIdentification(data.identification);
} else if (data.path_check) {
  drawPathCheck(data.path_check);
} else if (!data.live) {
  drawHead();
  drawAnswer();
  drawManeuver();
  drawHeadline();
  drawDifferences();
  drawDrive();
  drawPhasePlanes();
  if (tracks.length) {
    drawNumbers(section('numbers', 'Metrics'), tracks);
    const plants = runs.flatMap((run) => run.between.map(({ plants, numbers }) => ({
      label: `${runs.length > 1 ? `${run.name}: ` : ''}${plants.join(' – ')}`, numbers,
    })));
    if (plants.length) drawNumbers(section('between', 'Difference between plants at equal station'), plants);
  }
  drawExpectations();
  drawScenarios();
}
if (!data.live) drawFoot();  // the page of a run in progress is drawn by live.js instead
