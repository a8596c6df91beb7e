// Lets the browser keep the whole page, so that it opens without a network after the first visit (sw.js). It waits until what the user
// sees is there, and does nothing where the browser forbids it (plain http) or the user saves data.
const kBase = new URL('../../', import.meta.url);  // this file lies in v-HASH/common/
const kParts = new URL('../', import.meta.url).pathname.slice(kBase.pathname.length, -1);
const kLongest = 60_000;  // until it is kept whatever the page does  [ms]

// As long as this page is open, its version is kept.
navigator.locks?.request(`burr ${kBase.href} ${kParts}`, {mode: 'shared'}, () => new Promise(() => {}));

const begun = performance.now();
function keep() {
  const {burr} = window;
  if (!(burr?.loaded || burr?.open || burr?.trouble || performance.now() - begun > kLongest)) return void setTimeout(keep, 500);
  navigator.serviceWorker.register(new URL('sw.js', kBase), {updateViaCache: 'none'})
      .catch((trouble) => console.info(`The page is not kept for use without a network: ${trouble.message}`));
}
if (navigator.serviceWorker && !navigator.connection?.saveData) keep();
