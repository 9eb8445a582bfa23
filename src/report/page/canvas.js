// Creates the canvas of the 3D replay before the data and the libraries are loaded. A browser may
// need most of a second to start its graphics, which then overlaps with loading.

/** Returns the WebGL context of a canvas; null if the browser does not support WebGL. */
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
