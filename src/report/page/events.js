// Draws the events of a run on the time line.

// For each kind of event: the mark on the time line and the name in the legend.
const EVENT_KINDS = {
  collided: { mark: 'M-5 -5L5 5M-5 5L5 -5', name: 'collision' },
  rolled_over: { mark: 'M-5.5 4.5H5.5L0 -5.5Z', name: 'roll-over', filled: true },
  jackknifed: { mark: 'M-5 5L0 -5L5 5', name: 'jackknife' },
  ended: { mark: 'M-4.5 -4.5H4.5V4.5H-4.5Z', name: 'other end', filled: true },
  plan: { mark: 'M0 -6L6 0L0 6L-6 0Z', name: 'new plan', filled: true },
  known: { mark: 'M-5 0A5 5 0 1 1 5 0A5 5 0 1 1 -5 0', name: 'obstacle becomes known' },
  limit: { span: true, name: 'steering at its rate limit' },
  apart: { mark: 'M0 -7V7', name: 'largest difference' },
  astray: { mark: 'M0 -7V7', name: 'furthest from the path' },
};

/**
 * Returns all events in the order of time: {t, to, kind, text, track}. Only events with a duration
 * have `to`.
 */
function eventsOf() {
  const events = [];
  for (const track of tracks) {
    const add = (kind, t, text, to) => events.push({ kind, t, to, text, track });
    for (const plan of track.newPlans) add('plan', plan.from, 'new plan');
    for (const [, t] of track.events.known) add('known', t, 'obstacle becomes known');
    for (const [from, to] of track.events.rate_limit) {
      add('limit', from, `steering at its rate limit until ${brief(to)} s`, to);
    }
    if (track.end.t !== undefined && track.end.status !== 'arrived') {
      add(EVENT_KINDS[track.end.status] ? track.end.status : 'ended', track.end.t, statusText(track.end.status));
    }
  }
  const pair = pairs.map((one) => ({ one, apart: furthestApart(one) })).filter(({ apart }) => apart)
    .sort((a, b) => b.apart.size - a.apart.size)[0];
  if (pair) {
    events.push({ kind: 'apart', t: pair.apart.t, text: `${brief(pair.apart.size)} m apart`, track: pair.one.second });
  }
  for (const track of tracks) {
    const found = furthestFromPath(track);
    if (found) events.push({ kind: 'astray', t: found.t, text: `${brief(found.size)} m ${found.side} of the path`, track });
  }
  return events.sort((a, b) => a.t - b.t);
}

/**
 * Draws the time line, with a lane for each track below, which has marks for the track's events.
 */
function drawEventTrack(parent) {
  // no events are drawn while a run is in progress, because its extreme values are not yet known
  const all = data.live ? [] : eventsOf();
  const LANE = 20;
  // smallest distance between the center of the slider's knob and the ends of the slider [px]
  const SIDE = 9;
  const own = tracks.filter((track) => all.some((event) => event.track === track));
  const figure = parent.append('div').attr('class', 'event-track');
  drawTimeSlider(figure.append('div').attr('class', 'time-line'), 'track');
  if (!all.length) return;
  const svg = figure.append('svg').attr('role', 'group').attr('aria-label', 'Events on the time line').attr('height', LANE * own.length + 4);
  const lanes = own.map((track, i) => {
    const lane = svg.append('g').style('color', track.css);
    const y = LANE * (i + 0.5) + 2;
    return { track, lane, y, line: lane.append('path').attr('class', 'lane') };
  });
  const marks = all.map((event) => {
    const { lane, y } = lanes.find(({ track }) => track === event.track);
    const kind = EVENT_KINDS[event.kind];
    const mark = lane.append('g').attr('class', `event ${event.kind}`).attr('role', 'button').attr('tabindex', 0)
      .attr('aria-label', `${event.track.label}, ${brief(event.t)} s: ${event.text}`)
      .on('click', () => setTime(event.t))
      .on('keydown', () => ['Enter', ' '].includes(d3.event.key) && (d3.event.preventDefault(), setTime(event.t)));
    mark.append('title').text(`${event.track.label}, ${brief(event.t)} s: ${event.text}`);
    const shape = kind.span ? mark.append('rect').attr('y', y - 4).attr('height', 8).attr('rx', 2)
      : mark.append('path').attr('class', kind.filled ? 'filled' : null).attr('d', kind.mark);
    return { event, mark, shape, y, kind };
  });
  const cursor = svg.append('path').attr('class', 'cursor');
  let x = null;
  const place = () => x && cursor.attr('d', `M${x(now)} 0V${LANE * own.length + 4}`);
  new ResizeObserver(() => {
    const width = svg.node().clientWidth;
    if (width <= 2 * SIDE) return;
    x = d3.scaleLinear().domain([0, duration || 1]).range([SIDE, width - SIDE]);
    for (const { line, y, track } of lanes) line.attr('d', `M${SIDE} ${y}H${x(track.log.t[track.log.t.length - 1])}`);
    for (const { event, mark, shape, y, kind } of marks) {
      if (kind.span) shape.attr('x', x(event.t)).attr('width', Math.max(2, x(event.to) - x(event.t)));
      else mark.attr('transform', `translate(${x(event.t)} ${y})`);
    }
    place();
  }).observe(svg.node());
  bus.on('time.event_track', place);
  bus.on('visibility.event_track', () => {
    for (const { track, lane } of lanes) lane.style('display', track.visible ? null : 'none');
  });

  const key = figure.append('p').attr('class', 'key');
  for (const kind of Object.keys(EVENT_KINDS).filter((name) => all.some((event) => event.kind === name))) {
    const { mark, filled, span, name } = EVENT_KINDS[kind];
    const entry = key.append('span').attr('class', 'sign');
    const sign = entry.append('svg').attr('width', 16).attr('height', 14).attr('aria-hidden', 'true').append('g')
      .attr('class', `event ${kind}`).attr('transform', 'translate(8 7)');
    if (span) sign.append('rect').attr('x', -7).attr('y', -4).attr('width', 14).attr('height', 8).attr('rx', 2);
    else sign.append('path').attr('class', filled ? 'filled' : null).attr('d', mark);
    entry.append('span').text(name);
  }
}

/**
 * Draws a button for each event without duration. A click on the button shows the time of the
 * event.
 */
function drawEvents(parent) {
  const MOST = 16;
  if (data.live) return;
  const events = eventsOf().filter(({ kind }) => kind !== 'limit');
  if (!events.length) return;
  const list = parent.append('div').attr('class', 'events').attr('role', 'group').attr('aria-label', 'Events');
  // If there are too many events for the row of buttons, buttons for new plans are omitted first.
  const kept = events.length > MOST ? [...events].sort((a, b) => (a.kind === 'plan') - (b.kind === 'plan')).slice(0, MOST) : events;
  for (const { t, text, track } of kept.sort((a, b) => a.t - b.t)) {
    const button = list.append('button').attr('type', 'button').attr('title', `${track.label}: show this moment`)
      .on('click', () => setTime(t));
    button.append('span').attr('class', 'dot').style('color', track.css);
    button.append('span').text(`${brief(t)} s ${text}`);
  }
  if (events.length > MOST) list.append('span').attr('class', 'hint').text(`and ${events.length - MOST} more on the time line`);
}
