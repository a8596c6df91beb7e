// The words of the page in the present language.
import * as words from '../common/words.js';
import {make} from './ask.js';

const {word, number} = words;
const $ = (id) => document.getElementById(id);

export function dress_sound(sound) {
  $('sound').disabled = $('volume').disabled = sound.compiled === undefined || sound.trouble !== '';
  $('sound').textContent = word(sound.on ? 'mute' : 'sound_on');
  $('sound').title = sound.trouble;
  $('sound').setAttribute('aria-pressed', String(sound.on));
}

function name(id, key, tip) {
  $(id).textContent = word(key);
  if (tip) $(id).title = word(tip);
}
function choices(id, key, all, now, tip) {
  if (tip) $(id).title = word(tip);
  $(id).setAttribute('aria-label', word(key));
  $(id).replaceChildren(...all.map(([value, text]) => {
    const option = make('option', {value}, text);
    option.selected = value === now;
    return option;
  }));
}

export function dress(burr, {is_own, depth}) {
  for (const one of document.querySelectorAll('[data-word]')) one.textContent = word(one.dataset.word);
  for (const one of document.querySelectorAll('[data-word-label]')) one.setAttribute('aria-label', word(one.dataset.wordLabel));
  for (const id of ['undo', 'redo', 'reset']) name(id, id);
  for (const [id, key] of Object.entries({smaller: 'smaller', larger: 'larger', slower: 'slower', faster: 'faster', less: 'less_deep', more: 'deeper'})) {
    $(id).title = word(key);
    $(id).setAttribute('aria-label', word(key));
  }
  $('picture').setAttribute('aria-label', word('bone'));
  name('coolant', 'coolant', 'coolant_tip');
  name('suction', 'suction', 'suction_tip');
  name('sound', burr.sound.on ? 'mute' : 'sound_on');
  $('volume').title = word('volume');
  $('volume').setAttribute('aria-label', word('volume'));
  name('menu_open', 'menu');
  name('menu_title', 'menu');
  name('menu_close', 'close');
  name('card_title', 'card_title');
  name('card_text', 'card_text');
  name('card_limits', 'card_limits');
  name('card_close', 'begin_card');
  name('home', 'first_view');
  name('own', 'own_scan', 'own_tip');
  name('shape', 'save_shape', 'save_shape_tip');
  name('kept', 'kept_work');
  name('to_marks', 'back_to_marks');
  name('save', 'save', 'save_tip');
  const finer = burr.voxel === 0.5 && !is_own;
  $('finer').textContent = finer ? word('finer') : `${number(0.5, 2)} mm`;
  $('finer').title = word('finer_tip');
  name('finish', 'done_button');
  $('finish').title = `${word('done_button')} (Ctrl + Enter)`;
  name('show_steps', 'steps');
  choices('language', 'language', words.languages().map(({code, name: text}) => [code, text]), words.present());
  choices('mode', 'mode_title', ['free', 'learn', 'practise', 'exam'].map((mode) => [mode, word(`mode_${mode}`)]), burr.mode, 'mode_tip');
  $('case').title = word('case_tip');
  $('depth').textContent = number(depth, 1);
}
