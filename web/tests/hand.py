"""The scripted pointer of the tests of the page, as JavaScript."""
# A pointer that presses and circles; then it goes to the corner. Events of the page's own: those of the browser wait for
# a picture each, and a machine without a graphics card draws few.
POINTER = """(async (milliseconds) => {
  const canvas = document.getElementById('picture'), box = canvas.getBoundingClientRect();
  const send = (type, x, y, buttons) => canvas.dispatchEvent(new PointerEvent(type, {clientX: box.left + x,
      clientY: box.top + y, button: type === 'pointermove' ? -1 : 0, buttons, pointerId: 1, pointerType: 'mouse',
      bubbles: true, cancelable: true}));
  const wait = (ms) => new Promise((go) => setTimeout(go, ms));
  const x = 0.5 * box.width, y = 0.5 * box.height;
  send('pointermove', x, y, 0);
  await wait(1500);
  const place = burr.place();
  send('pointerdown', x, y, 1);
  const begun = burr.state.ticks;
  const end = performance.now() + 120000;
  while (burr.state.ticks < begun + milliseconds && performance.now() < end) {
    const turn = performance.now() / 400;
    send('pointermove', x + 8 * Math.cos(turn), y + 8 * Math.sin(turn), 1);
    await wait(16);
  }
  const pressed = {...burr.figures};
  send('pointerup', x, y, 0);
  await wait(300);
  send('pointermove', 4, box.height - 4, 0);
  await wait(1500);
  return {place, pressed};
})"""
PARK = """(() => {
  const canvas = document.getElementById('picture'), box = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: box.left + 4, clientY: box.top + box.height - 4,
      button: -1, pointerId: 1, pointerType: 'mouse', bubbles: true}));
})()"""
