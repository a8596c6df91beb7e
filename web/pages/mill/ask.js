// One question at a time, in the dialog #ask, and the elements that the parts of the page are made of.
const $ = (id) => document.getElementById(id);

// make('p', {class: 'dim'}, 'text', child, ...)
export function make(tag, with_what = {}, ...inside) {
  const one = document.createElement(tag);
  for (const [name, value] of Object.entries(with_what)) {
    if (name === 'click') one.addEventListener('click', value);
    else if (typeof value === 'boolean') one.toggleAttribute(name, value);
    else one.setAttribute(name, value);
  }
  one.append(...inside.filter((part) => part !== null && part !== '' && part !== undefined && part !== false));
  return one;
}
export const button = (text, click, more = {}) => make('button', {type: 'button', click, ...more}, text);

// Shows it. inside: what stands below the title; answers: [[id, text, act]]; the first one has the keyboard. Escape is no answer.
export function ask(title, inside, answers) {
  const dialog = $('ask');
  if (dialog.open) dialog.close();
  dialog.replaceChildren(make('h2', {id: 'ask_title'}, title), ...inside.filter(Boolean),
      make('nav', {}, ...answers.map(([id, text, act]) => button(text, () => { dialog.close(); act?.(); }, {id}))));
  dialog.setAttribute('aria-labelledby', 'ask_title');
  dialog.oncancel = null;  // of the question before
  dialog.showModal();
  return dialog;
}
