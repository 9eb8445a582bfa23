// Shows the videos of the runs, synchronized with the current time of the page.

function drawFilms(parent) {
  const filmed = runs.filter((run) => run.film);
  if (!filmed.length) return;
  const films = parent.append('div').attr('class', 'films');
  for (const run of filmed) {
    const figure = films.append('figure').attr('class', 'panel');
    const video = figure.append('video').attr('playsinline', '').attr('preload', 'auto').attr('tabindex', 0)
      .attr('aria-label', `Film of ${run.name}`).property('muted', true).node();
    // The browser's video controls would cover charts and captions in the video, so the controls
    // are shown only while the user points at or focuses the video.
    const showControls = (use) => () => { video.controls = use; };
    for (const event of ['mouseenter', 'focus', 'click']) video.addEventListener(event, showControls(true));
    for (const event of ['mouseleave', 'blur']) video.addEventListener(event, showControls(false));
    if (runs.length > 1) figure.append('figcaption').text(run.name);
    if (run.film.url) {
      video.src = run.film.url;
    } else {
      const bytes = Uint8Array.from(atob(run.film.base64), (c) => c.charCodeAt(0));
      video.src = URL.createObjectURL(new Blob([bytes], { type: 'video/mp4' }));
      delete run.film.base64;
    }
    // A timer updates the page's current time while the video plays, because the browser's own time
    // event occurs too rarely.
    let ticking = null;
    video.addEventListener('play', () => {
      ticking = d3.timer(() => setTime(video.currentTime, 'film'));
    });
    video.addEventListener('pause', () => ticking && ticking.stop());
    video.addEventListener('seeked', () => {
      if (document.activeElement === video) setTime(video.currentTime, 'film');
    });
    let wanted = null;
    const seek = () => {
      if (wanted === null || video.seeking || !video.paused) return;
      video.currentTime = wanted;
      wanted = null;
    };
    video.addEventListener('seeked', seek);
    video.addEventListener('loadedmetadata', seek);
    bus.on(`time.film${runs.indexOf(run)}`, (time, from) => {
      if (from === 'film') return;
      wanted = Math.min(time, Number.isFinite(video.duration) ? video.duration : time);
      if (video.readyState > 0) seek();
    });
  }
}
