// The canvas of the 3D replay. The canvas is created before the data and the libraries are loaded.
// Starting the graphics can take a browser most of a second, which then overlaps with loading.

/** The WebGL context of a canvas; null if the browser has no WebGL. */
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
