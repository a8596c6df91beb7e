#include "window/words.h"

#include <array>

namespace burr::app {
namespace {

struct Entry {
  Word which;
  const char *english, *swedish;
};

constexpr std::array kWords = {
    Entry{Word::force, "Force", "Kraft"},
    Entry{Word::limit_user, "yours", "din"},
    Entry{Word::limit_device, "device", "don"},
    Entry{Word::press, "Press", "Tryck"},
    Entry{Word::pressing, "pressing", "trycker"},
    Entry{Word::lifted, "lifted", "lyft"},
    Entry{Word::speed, "Speed", "Varvtal"},
    Entry{Word::load, "load {:.0f} %", "last {:.0f} %"},
    Entry{Word::burr, "Burr", "Borr"},
    Entry{Word::removed, "Removed", "Borttaget"},
    Entry{Word::time, "Time", "Tid"},
    Entry{Word::nearest, "To {}", "Till {}"},
    Entry{Word::nearest_far, "To what to spare", "Till det som sparas"},
    Entry{Word::ticks, "Ticks", "Takt"},
    Entry{Word::ticks_good, "steady", "jämn"},
    Entry{Word::ticks_busy, "busy", "pressad"},
    Entry{Word::ticks_lost, "losing", "tappar"},
    Entry{
        Word::ticks_tail,
        "One tick of touch each millisecond.\n99 of 100 took at most {:.0f} us, the longest {:.0f} "
        "us.\n"
        "{} missed since the start.",
        "Ett känselsteg varje millisekund.\n99 av 100 tog högst {:.0f} us, det längsta {:.0f} us.\n"
        "{} uteblev sedan starten."},
    Entry{Word::picture_whole, "The picture is drawn whole.", "Bilden ritas hel."},
    Entry{Word::picture_no_hollows, "The picture leaves out: shade in hollows.",
          "Bilden utelämnar: skugga i gropar."},
    Entry{Word::picture_coarser, "The picture leaves out: shade in hollows, fine detail.",
          "Bilden utelämnar: skugga i gropar, fina detaljer."},
    Entry{Word::picture_fewer,
          "The picture leaves out: shade in hollows, fine detail, an eighth of its sharpness.",
          "Bilden utelämnar: skugga i gropar, fina detaljer, en åttondel av skärpan."},
    Entry{Word::picture_fewest,
          "The picture leaves out: shade in hollows, fine detail, a quarter of its sharpness.",
          "Bilden utelämnar: skugga i gropar, fina detaljer, en fjärdedel av skärpan."},
    Entry{Word::cut, "Cut", "Fräs"},
    Entry{Word::add, "Add", "Lägg på"},
    Entry{Word::touch, "Touch", "Känn"},
    Entry{Word::undo, "Undo", "Ångra"},
    Entry{Word::redo, "Redo", "Gör om"},
    Entry{Word::reset, "Reset", "Börja om"},
    Entry{Word::smaller, "Smaller burr", "Mindre borr"},
    Entry{Word::larger, "Larger burr", "Större borr"},
    Entry{Word::slower, "Slower", "Långsammare"},
    Entry{Word::faster, "Faster", "Snabbare"},
    Entry{Word::settings, "Settings", "Inställn."},
    Entry{Word::help, "Help", "Hjälp"},
    Entry{Word::leave, "Leave", "Lämna"},
    Entry{Word::undone, "last stroke undone", "senaste draget ångrat"},
    Entry{Word::redone, "stroke redone", "draget gjort om"},
    Entry{Word::back_to_start, "everything back to the start", "allt som från början"},
    Entry{Word::now_cut, "the burr cuts", "borren fräser"},
    Entry{Word::now_add, "the burr adds material", "borren lägger på material"},
    Entry{Word::now_touch, "the burr only touches", "borren bara känner"},
    Entry{Word::burr_now, "burr of {:g} mm", "borr på {:g} mm"},
    Entry{Word::speed_now, "{:.0f} turns a minute", "{:.0f} varv i minuten"},
    Entry{Word::no_room, "no room here for a larger burr: lift it first",
          "här finns ingen plats för en större borr: lyft den först"},
    Entry{Word::no_burr, "burrs go from {:g} to {:g} mm in this bone",
          "i detta ben går borrar från {:g} till {:g} mm"},
    Entry{Word::picture_left, "picture kept: {}", "bild sparad: {}"},
    Entry{Word::let_go, "the force was let go: {}", "kraften släpptes: {}"},
    Entry{Word::help_title, "Keys and mouse", "Tangenter och mus"},
    Entry{Word::help_hand, "The hand", "Handen"},
    Entry{Word::help_view, "The view", "Vyn"},
    Entry{Word::help_tools, "Tools", "Verktyg"},
    Entry{Word::help_program, "Program", "Program"},
    Entry{Word::help_mill, "press into the bone while held", "tryck mot benet så länge den hålls"},
    Entry{Word::help_hold, "press on and off, without holding", "tryck på och av, utan att hålla"},
    Entry{Word::help_push, "push deeper or less deep", "tryck djupare eller grundare"},
    Entry{Word::help_turn, "turn the bone", "vrid benet"},
    Entry{Word::help_shift, "shift it", "flytta det"},
    Entry{Word::help_zoom, "nearer, farther", "närmare, längre bort"},
    Entry{Word::help_first_view, "first view", "första vyn"},
    Entry{Word::help_sizes, "smaller or larger burr", "mindre eller större borr"},
    Entry{Word::help_speeds, "slower or faster", "långsammare eller snabbare"},
    Entry{Word::help_modes, "cut, add, only touch", "fräs, lägg på, känn bara"},
    Entry{Word::help_undo, "undo, redo a stroke", "ångra, gör om ett drag"},
    Entry{Word::help_reset, "everything back", "allt tillbaka"},
    Entry{Word::help_hide, "hide or show all panels", "göm eller visa alla paneler"},
    Entry{Word::help_settings, "settings", "inställningar"},
    Entry{Word::help_picture, "keep a picture", "spara en bild"},
    Entry{Word::help_quit, "leave", "lämna"},
    Entry{Word::help_slices, "slices through the tip; nearer, farther",
          "snitt genom spetsen; närmare, längre bort"},
    Entry{Word::help_labels, "colours of tissues on, off", "vävnadernas färger på, av"},
    Entry{Word::axial, "axial", "axial"},
    Entry{Word::coronal, "coronal", "koronal"},
    Entry{Word::sagittal, "sagittal", "sagittal"},
    Entry{Word::sound_on, "sound on", "ljud på"},
    Entry{Word::sound_off, "sound off", "ljud av"},
    Entry{Word::sound_loudness, "sound {:.0f} dB", "ljud {:.0f} dB"},
    Entry{Word::help_sound, "sound on, off", "ljud på, av"},
    Entry{Word::help_loudness, "quieter, louder", "tystare, högre"},
    Entry{Word::help_ghost,
          "The blue dot is your hand: where it would be if the bone gave way. The farther it is "
          "from\n"
          "the burr, the harder you press; the orange arrow is the bone's force on the hand.",
          "Den blå pricken är din hand: där den vore om benet gav vika. Ju längre från borren, "
          "desto\n"
          "hårdare trycker du; den orange pilen är benets kraft på handen."},
    Entry{Word::key_left, "left button", "vänster knapp"},
    Entry{Word::key_right, "right button", "höger knapp"},
    Entry{Word::key_middle, "middle button", "mittknapp"},
    Entry{Word::key_wheel, "wheel, two fingers", "hjul, två fingrar"},
    Entry{Word::key_ctrl_wheel, "Ctrl + wheel", "Ctrl + hjul"},
    Entry{Word::key_shift_wheel, "Shift + wheel", "Skift + hjul"},
    Entry{Word::key_space, "Space", "Mellanslag"},
    Entry{Word::key_arrows, "arrows", "piltangenter"},
    Entry{Word::key_shift_arrows, "Shift + arrows", "Skift + pilar"},
    Entry{Word::settings_title, "Settings", "Inställningar"},
    Entry{Word::language, "Language", "Språk"},
    Entry{Word::set_look, "Look", "Utseende"},
    Entry{Word::set_scale, "Size of letters", "Textstorlek"},
    Entry{Word::set_panels, "Panels at the start", "Paneler från början"},
    Entry{Word::set_help, "Help at the start", "Hjälp från början"},
    Entry{Word::set_sessions, "Sessions", "Sessioner"},
    Entry{Word::set_autosave, "Save by itself", "Spara av sig själv"},
    Entry{Word::set_kept, "Keep at most", "Behåll högst"},
    Entry{Word::set_mb, "... and at most", "... och högst"},
    Entry{Word::set_hand, "Hand", "Hand"},
    Entry{Word::set_left_handed, "Left-handed", "Vänsterhänt"},
    Entry{Word::set_force, "Your force limit", "Din kraftgräns"},
    Entry{Word::set_press, "Press of the mouse", "Musens tryck"},
    Entry{Word::set_view, "View", "Vy"},
    Entry{Word::set_turn, "Pace of turning", "Vridningens takt"},
    Entry{Word::set_zoom, "Pace of zooming", "Zoomningens takt"},
    Entry{Word::set_privacy, "Privacy", "Integritet"},
    Entry{Word::set_recent_names, "Show names of scans", "Visa skanningars namn"},
    Entry{Word::set_file, "Kept in {}", "Sparas i {}"},
    Entry{Word::set_not_kept, "Not kept: there is no home folder",
          "Sparas inte: det finns ingen hemmapp"},
    Entry{Word::cancel, "Cancel", "Avbryt"},
    Entry{Word::stopping, "stopping ...", "stannar ..."},
    Entry{Word::loading, "Loading {}", "Läser in {}"},
    Entry{Word::start_hello, "Cut bone by hand", "Fräs ben för hand"},
    Entry{Word::start_cases, "Cases", "Fall"},
    Entry{Word::start_own, "Your own CT", "Din egen CT"},
    Entry{Word::start_drop, "Drop a file or a DICOM folder\nanywhere in this window",
          "Släpp en fil eller en DICOM-mapp\nvar som helst i fönstret"},
    Entry{Word::start_path, "or type its path here", "eller skriv sökvägen här"},
    Entry{Word::start_open, "Open", "Öppna"},
    Entry{Word::start_file, "File ...", "Fil ..."},
    Entry{Word::start_folder, "Folder ...", "Mapp ..."},
    Entry{Word::start_recent, "Recent", "Senaste"},
    Entry{Word::start_sessions, "Continue a session", "Fortsätt en session"},
    Entry{Word::start_none, "nothing yet", "inget ännu"},
    Entry{Word::start_quit, "Quit", "Avsluta"},
    Entry{Word::start_scan, "a scan", "en skanning"},
    Entry{Word::start_case_file, "a case", "ett fall"},
    Entry{Word::start_unclean, "ended unexpectedly", "slutade oväntat"},
    Entry{Word::start_kept, "kept", "sparad"},
    Entry{Word::start_trouble, "This did not work", "Det gick inte"},
    Entry{Word::case_temporal_bone, "Temporal bone", "Tinningben"},
    Entry{Word::case_jaw, "Lower jaw", "Underkäke"},
    Entry{Word::case_spine, "Lumbar vertebra", "Ländkota"},
    Entry{Word::case_tooth, "Tooth", "Tand"},
    Entry{Word::case_block, "Block to practise", "Övningsblock"},
    Entry{Word::session_kept, "session kept: the start page can go on from here at any time",
          "sessionen är sparad: startsidan kan fortsätta härifrån när som helst"},
    Entry{Word::session_not_kept, "this session is not recorded, so it cannot be kept",
          "denna session spelas inte in och kan inte sparas"},
    Entry{Word::key_save, "keep this session", "spara sessionen"},
    Entry{Word::flag_not_finite, "number trouble", "taltrassel"},
    Entry{Word::flag_hand_lost, "hand lost", "handen borta"},
    Entry{Word::flag_watchdog, "ticks lost", "steg uteblev"},
    Entry{Word::flag_jump, "hand leapt", "handen hoppade"},
    Entry{Word::flag_force_limited, "force limited", "kraften begränsad"},
    Entry{Word::flag_thermal, "motors warm", "motorerna varma"},
    Entry{Word::flag_candidates, "too many contacts", "för många kontakter"},
    Entry{Word::flag_reserve, "no room to add", "ingen plats att lägga på"},
    Entry{Word::flag_undo_full, "undo full", "ångra fullt"},
    Entry{Word::flag_restoring, "restoring", "återställer"},
    Entry{Word::flag_not_cut, "not all cut", "allt fräses inte"},
    Entry{Word::flag_put_off, "cutting in turns", "fräser i omgångar"},
};
static_assert(kWords.size() == static_cast<std::size_t>(Word::count_), "every Word has its entry");

Language language_now = Language::english;

}  // namespace

void speak(Language language) { language_now = language; }
Language spoken() { return language_now; }

const char* word(Word which, Language language) {
  const Entry& entry = kWords[static_cast<std::size_t>(which)];
  return language == Language::swedish ? entry.swedish : entry.english;
}
const char* word(Word which) { return word(which, language_now); }

bool words_in_order() {
  for (std::size_t n = 0; n < kWords.size(); ++n)
    if (kWords[n].which != static_cast<Word>(n)) return false;
  return true;
}

}  // namespace burr::app
