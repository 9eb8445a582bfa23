// The canvas of the replay. It comes before the data and the libraries, because a browser may take most of a second to
// start its graphics: it does so while it reads them.

/** The WebGL context of a canvas; null in a browser that has none. */
function webGlOf(canvas) {
  const wanted = { alpha: false, antialias: true, stencil: false };
  try {
    return canvas.getContext('webgl', wanted) || canvas.getContext('experimental-webgl', wanted);
  } catch (error) {
    return null;
  }
}

const sceneCanvas = document.createElement('canvas');
const sceneContext = webGlOf(sceneCanvas);
