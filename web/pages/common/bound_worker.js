// A worker under the page's own policy. A worker from an address has the policy that the host sends with its script, so on a host
// that sends none it could ask other hosts and run text as code. One from a blob inherits the policy of the page that starts it.
const blobs = new Map();  // address of a module -> address of a script that loads it

// address: a URL of a module of this host.
export function bound_worker(address) {
  const {href} = address;
  if (!blobs.has(href))
    blobs.set(href, URL.createObjectURL(new Blob([`import ${JSON.stringify(href)};`], {type: 'text/javascript'})));
  return new Worker(blobs.get(href), {type: 'module'});
}
