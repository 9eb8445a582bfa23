// Creates the canvas of the 3D replay before the data and the libraries are loaded. Creating the
// canvas early lets the browser start its graphics, which may take most of a second, while data and
// libraries load.

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
