// The size of a picture on the page, in pixels of the screen; at most two of them to a pixel of the page.
export function wanted_size(canvas) {
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  return [Math.max(1, Math.round(canvas.clientWidth * scale)), Math.max(1, Math.round(canvas.clientHeight * scale))];
}

// Gives the canvas that size. True: it had another.
export function fit(canvas) {
  const [wide, high] = wanted_size(canvas);
  if (canvas.width === wide && canvas.height === high) return false;
  canvas.width = wide;
  canvas.height = high;
  return true;
}

// Whether the browser has taken the picture away. A picture can fail before the event that says so.
export const is_lost = (canvas) => canvas.getContext('webgl2')?.isContextLost() ?? true;
