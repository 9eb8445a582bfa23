// Implements the page of a run in progress, which receives rows from the server of the run, and
// sends commands that control the run.

const SPEEDS = [0.1, 0.5, 1, 2, 5, 10, 'max'];
const live = {
  socket: null,
  state: null,       // last state message received from the server: {id, paused, speed}
  connected: false,
  finished: false,
  following: true,   // whether the page always shows the newest state
};

function ask(message) {
  if (live.connected) live.socket.send(JSON.stringify(message));
}

const togglePause = () => ask({ do: live.state && live.state.paused ? 'resume' : 'pause' });
const stepOnce = () => ask({ do: 'step' });

/** Keeps the first `first` entries of each column and appends the new rows. */
function putRows(columns, first, rows) {
  columns.forEach((column, i) => {
    column.length = Math.min(column.length, first);
    for (const row of rows) column.push(row[i]);
  });
}

/**
 * Appends rows to the logs. `first` has the numbers of earlier rows, poses and plans. After a
 * reconnection, the server sends all rows again.
 */
function takeRows(plants) {
  plants.forEach(({ first, rows, poses, plans }, i) => {
    const track = tracks[i];
    if (rows.length) putRows(Object.values(track.log), first[0], rows);
    const car = replay && replay.cars[i];
    if (car && poses.length) putRows([car.motion.t, ...Object.values(car.motion.channels)], first[1], poses);
    track.newPlans.splice(first[2], plans.length, ...plans);
  });
}

/**
 * Draws new rows. The rate of drawing is limited, so that the browser has three quarters of its
 * time for other work.
 */
const drawSoon = (() => {
  let waiting = false;
  let free = 0;
  const draw = () => {
    waiting = false;
    const begin = performance.now();
    rowsAdded();
    if (live.following) setTime(duration, 'live');
    const end = performance.now();
    free = end + 3 * (end - begin);
  };
  return () => {
    if (waiting) return;
    waiting = true;
    setTimeout(() => requestAnimationFrame(draw), Math.max(0, free - performance.now()));
  };
})();

function take(message) {
  if (message.type === 'rows') {
    takeRows(message.plants);
    drawSoon();
  } else if (message.type === 'finished') {
    live.finished = true;
    // After reloading, the page is scrolled to the top, where the verdict is.
    window.history.scrollRestoration = 'manual';
    // Reloads the page, because the server now serves the finished report.
    window.location.reload();
  } else if (message.type === 'state') {
    // Reloads the page if the server now serves another run.
    if (message.id !== data.live.id) window.location.reload();
    live.state = message;
    showState();
  }
}

function connect() {
  const AGAIN = 1000;  // time until the next attempt to connect [ms]
  live.socket = new WebSocket(`ws://${window.location.host}/live`);
  live.socket.addEventListener('open', () => { live.connected = true; });
  live.socket.addEventListener('message', (event) => take(JSON.parse(event.data)));
  live.socket.addEventListener('close', () => {
    live.connected = false;
    showState();
    if (!live.finished) setTimeout(connect, AGAIN);
  });
}

let showState = () => {};

function drawControls(parent) {
  const bar = parent.append('div').attr('class', 'live panel').attr('role', 'group').attr('aria-label', 'Control of the run');
  const badge = bar.append('span').attr('id', 'verdict').attr('class', 'badge plain').attr('role', 'status').text('connecting');
  const clock = bar.append('output').attr('class', 'clock').attr('id', 'live-time');
  const button = (id, title, act) => bar.append('button').attr('type', 'button').attr('id', id).attr('title', title).on('click', act);
  const pause = button('pause', 'Space', togglePause).text('Pause run');
  button('step', 'One control period; key .', stepOnce).text('Step');
  const speed = bar.append('label').attr('class', 'speed').text('Speed ').append('select').attr('id', 'speed');
  speed.on('change', () => {
    const { value } = speed.node();
    ask({ do: 'speed', speed: value === 'max' ? value : Number(value) });
  });
  const follow = button('follow', 'Show the newest moment; key End', () => setFollowing(true)).text('Live');

  function setFollowing(on) {
    live.following = on;
    follow.attr('aria-pressed', String(on));
    if (on) setTime(duration, 'live');
  }
  setFollowing(true);

  showState = () => {
    const { state, connected } = live;
    bar.selectAll('button:not(#follow), select').property('disabled', !connected);
    badge.attr('class', `badge ${connected ? 'plain' : 'bad'}`)
      .text(!connected ? 'no connection' : state && state.paused ? 'paused' : 'running');
    if (!state) return;
    pause.text(state.paused ? 'Resume run' : 'Pause run');
    const choices = Array.from(new Set([...SPEEDS, state.speed]))
      .sort((a, b) => (a === 'max') - (b === 'max') || a - b);
    const options = speed.selectAll('option').data(choices, (choice) => choice);
    options.exit().remove();
    options.enter().append('option').attr('value', (choice) => choice)
      .text((choice) => (choice === 'max' ? 'max' : `${shown(choice)}×`)).merge(options).order();
    speed.property('value', state.speed);
  };

  // If the user selects an earlier time, the page no longer shows the newest state automatically.
  bus.on('time.live', (time, from) => {
    if (from !== 'live' && live.following && time < duration) setFollowing(false);
  });
  bus.on('rows.live', () => clock.text(`${duration.toFixed(2)} s simulated`));
  document.addEventListener('keydown', (event) => {
    const busy = event.target.closest('button, input, select, summary, a, video');
    if (busy || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = { ' ': togglePause, '.': stepOnce, End: () => setFollowing(true) }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function drawLive() {
  const [run] = runs;
  const header = root.append('header');
  header.append('div').attr('class', 'heading').append('h1').text(run.scenario);
  facts(header, [
    run.name !== run.scenario && `folder ${run.name}`, planFact(run.plan), `car: ${run.car.name}`, `seed ${run.seed}`,
    `Trackbed ${run.versions.trackbed}`, run.versions.physics,
  ]);
  const controls = root.append('div').attr('class', 'live-bar');
  drawReplay(root.append('div'));
  drawDrive();
  drawPhasePlanes();
  drawScenarios();
  drawFoot();
  drawControls(controls);
  connect();
}

drawLive();
