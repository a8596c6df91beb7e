#include "burr/importing/tissue_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace burr::importing {
namespace {

using volume::TissueKind;

// A guess, for the picture only: it oozes where a vessel runs.
constexpr double kSpongyBleeds = 0.15, kMarrowBleeds = 0.3;

enum class What : std::uint8_t {
  hard,     // bone, tooth, implant
  region,   // says where: bone if the name says nothing else ("mastoid", "mandibular")
  spongy,   // trabecular bone
  marrow,   // bone marrow: cut with the bone around it
  ossicle,  // hard, and to be spared
  soft,
  pulp,      // soft; oozes
  precious,  // soft and to be spared: nerve, dura, brain, inner ear
  vessel,    // soft, to be spared, bleeds
  air,
};

struct Rows {
  What what;
  // Phrases, separated by commas. A word may begin or end with * (anything). ^ before a phrase: the
  // noun comes first in this language, so at the beginning of a name it says what the thing is
  // ("nervus mandibularis" is a nerve); otherwise the last word does ("vertebral artery").
  std::initializer_list<const char*> phrases;
};

// The table. Longer phrases count before shorter ones; within a word the part that ends last counts
// ("Kieferhöhle" is a Höhle).
// NOLINTBEGIN(bugprone-suspicious-missing-comma): long lists of words are broken over two lines
const std::initializer_list<Rows> kTable = {
    // English
    {What::hard,
     {"*bone, *bones, bony, tooth*, teeth, enamel, dentin*, cement*, skull*, mandible*, maxilla",
      "mandibula, *vertebra, *vertebras, implant*, screw*, crown*, jaw*, caries, diploe, otic "
      "capsule, plate",
      "tegmen, wall, vault, skull base, base, rib, ribs, molar*, incisor*, canine*, bridge, "
      "filling",
      "canal wall, canal bone, sinus plate, sinus wall, sinus bone, sinus floor, sternum, "
      "scapula*, clavic*, humer*, femur*, femor*, hip, hips, tibia*",
      "fibula*, sacrum, pelvis, zygoma, cranium, radius, ulna, patella, orbital floor",
      "palate, hard palate, metal, labyrinthine bone",
      "ceramic, hyoid, coccyx, spine, bracket*, restoration*, osseous, ossified, plaster, pmma"}},
    {What::region,
     {"mandib*, maxill*, vertebr*, *vertebral, cortical, mastoid*, petrous*, cranial, ethmoid*",
      "sphenoid*, temporal, parietal, occipital, zygom*, alveolar, osseous, maxilar*, petros*",
      "mandibul*, squam*, hyoid*, palatin*"}},
    {What::spongy, {"trabecul*, cancell*, spongios*"}},
    {What::marrow, {"marrow"}},
    {What::ossicle,
     {"ossic*, malleus, incus, stapes, bony labyrinth*, osseous labyrinth*, bony cochlea",
      "labyrinthus osseus, knöcherne* labyrinth, labyrinthe osseux, laberinto óseo"}},
    {What::soft,
     {"*canal, *canals, skin, muscle*, fat, ligament*, tendon*, cartilag*, disc, discs, disk",
      "disks, membran*, mucosa*, gum, gums, gingiva*, soft, tissue*, joint*, tongue*, tmj, gland*",
      "eardrum*, soft palate, heart*, atrium*, lung*, liver, kidney*, spleen, stomach, pancreas",
      "gallbladder, bladder, bowel*, colon, duodenum, esophag*, oesophag*, prostate, thyroid*",
      "parotid*, gluteus*, iliopsoas*, autochthon*, psoas*, masseter*, tumor*, tumour*, cyst*",
      "temporalis, pterygoid*, buccinator, digastric*, lesion*, granulation*, cholesteatom*, "
      "turbinate*, lip, lips, cheek, foramen, foramina, sac",
      "meatus, semicircular, contrast, blood, fluid, abscess*, larynx, adrenal*, lens"}},
    {What::pulp, {"pulp*"}},
    {What::precious,
     {"nerve*, dura, dural, chorda*, labyrinth*, cochlea*, vestib*, *cord, brain*, aqueduct*, iac",
      "semicircular canal*, eye*, cerebr*, cerebell*, cerebral cortex, csf, ventricle*, thalam*",
      "lobe, lobes, gyrus, gyri, hippocamp*, amygdal*, putamen, caudate, pallidum, white matter, "
      "gray matter, grey matter",
      "ctx, ctx lh, ctx rh, wm lh, wm rh, hypothalam*, pituitar*, mening*, inner ear, ganglion*",
      "internal auditory, internal acoustic, internal auditory canal, internal auditory meatus",
      "internal acoustic meatus, internal acoustic canal, internal meatus, mandibular canal*",
      "alveolar canal*, alveolar inferior canal*, incisive canal*, facial canal, optic canal*",
      "spinal canal, vertebral canal, thecal sac, dural sac, orbit, orbits, endolymph*, perilymph*",
      "utricle, saccule, round window, oval window, brain stem, chiasm*, facial nerve canal, ian"}},
    {What::vessel,
     {"*vein, *veins, *artery, *arteries, arterial, venous, *vessel, *vessels, carotid*, jugular*",
      "sinus, sinuses, bulb, ica, aorta*, vena cava, carotid canal, sigmoid"}},
    {What::air,
     {"air, ear canal*, auditory canal*, auditory canal ext*, external auditory, eac, air cell*",
      "external auditory canal*, external auditory meatus, external acoustic meatus, airway*",
      "external acoustic canal, outer ear canal, external meatus, external ear canal, trachea*",
      "middle ear, tympanic cavity, background, tympanum, exterior, mastoid cell*, mastoid cells",
      "mastoid air cell*, ethmoid cell*, ethmoid air cell*, ethmoidal cell*, mastoid antrum",
      "maxillary sinus*, frontal sinus*, ethmoid sinus*, ethmoidal sinus*, sphenoid sinus*",
      "sphenoidal sinus*, paranasal sinus*, nasal sinus*, nasal cavit*, nasal passage*, pharynx",
      "nasopharynx, oropharynx, hypopharynx, oral cavity, eustachian tube*, epitympan*, sinus air",
      "paranasal, bronch*"}},

    // Latin
    {What::hard,
     {"^os, ^ossa, ^dens, ^dentes, ^corpus mandib*, ^ramus mandib*, ^processus, ^pars petros*",
      "^costa, ^costae, ^calva",
      "^lamina, ^paries, ^tegmen, ^calvaria, ^radix, ^corona, ^spina, palatum durum, atlas, axis"}},
    {What::spongy, {"^substantia spongiosa"}},
    {What::marrow, {"^medulla ossium"}},
    {What::soft,
     {"^canalis, ^canales, ^ductus, ^cutis, ^musculus, ^musculi, ^m *, ^mm *, ^cartilago",
      "^discus, ^ligamentum, ^lig *, ^tendo, ^membrana, ^tunica, ^lingua, ^glandula, ^articulatio",
      "^foramen, ^fossa pterygopalatina, palatum molle, velum palatinum, ^concha, ^septum nasi"}},
    {What::pulp, {"^pulpa"}},
    {What::precious,
     {"^nervus, ^nervi, ^n *, ^nn *, dura mater, pia mater, arachnoid*, encephal*, cerebr*",
      "^medulla spinalis, ^medulla oblongata, ^truncus encephali, ^truncus cerebri, ^oculus",
      "^bulbus oculi, ^bulbus, ^meatus acusticus internus, ^porus acusticus internus, ^plexus",
      "^labyrinthus, ^vestibulum, ^canales semicirculares, ^canalis semicircularis",
      "^ductus semicircularis, ^ductus semicirculares, ^ductus cochlearis, ^saccus, ^aqu*ductus",
      "^canalis mandib*, ^canalis nervi *, ^canalis facialis, ^canalis opticus, ^radix nervi",
      "^canalis vertebralis, ^canalis incisivus, ^chorda, facialis, fazialis, trigeminus, vagus",
      "opticus, alveolaris inferior, vestibulocochlearis, ^ganglion, ^fenestra, ^orbita, ^auris "
      "interna, ^hypophysis, ^chiasma, ^cauda equina, ^saccus duralis, trochlearis, abducens",
      "hypoglossus, glossopharyngeus, oculomotorius, accessorius"}},
    {What::vessel,
     {"^arteria, ^arteriae, ^a *, ^aa *, ^vena, ^venae, ^v *, ^vv *, ^sinus, ^vas, ^vasa, carotis",
      "karotis, jugularis, ^bulbus venae jugularis, ^bulbus jugularis, ^bulbus superior",
      "^canalis caroticus, ^truncus"}},
    {What::air,
     {"^sinus maxill*, ^sinus front*, ^sinus sphen*, ^sinus ethmo*, ^sinus paranas*, ^aer",
      "^meatus acusticus externus, ^porus acusticus externus, ^cavum tympani, ^cavitas tympan*",
      "^cellula*, ^cellulae, ^cavitas nasi, ^cavum nasi, ^cavitas oris, ^cavum oris, ^tuba audit*",
      "^antrum, ^antrum mastoid*, ^auris media, ^recessus epitympan*"}},

    // German
    {What::hard,
     {"*knochen, *knöchern*, knöchern*, *bein, *kiefer, *kieferknochen, *zahn, *zähne, zahn*",
      "*backenzahn, *schädel, schädel*, *kalotte, *wirbel, *wirbelkörper, *wirbelsäule, *rippe",
      "*rippen, *schmelz, *dentin, *zement, *implantat, *implantate, *schraube, *schrauben",
      "*krone, *kronen, *füllung, *fortsatz, *becken, *schulterblatt, *basis, *wurzel, *wurzeln",
      "*wand, *karies, *platte, kortikalis, kompakta, kortikal*, *metall, *molar, "
      "labyrinthkapsel"}},
    {What::spongy, {"spongiosa*, *spongiosa, trabekel*, trabekulär*"}},
    {What::marrow, {"*knochenmark"}},
    {What::ossicle, {"*knöchelchen, hammer, amboss, amboß, steigbügel"}},
    {What::soft,
     {"*kanal, *kanäle, *haut, *muskel, *muskeln, *muskulatur, *fett, *knorpel, *bandscheibe*",
      "band, bänder, *längsband, *seitenband, *sehne, *sehnen, *gewebe, *weichteile, *zunge, "
      "*drüse, *drüsen, *gelenk",
      "*zahnfleisch, *schleimhaut, *trommelfell, *lippe, *lippen, *wange, *zyste, *tumor, *herz",
      "*lunge, *leber, *niere, *milz, *speiseröhre, *ohrmuschel, *nasenmuschel, *muschel, *blut",
      "gaumensegel, weicher gaumen, kinnloch, *kehlkopf, *meniskus, *membran, *cholesteatom"}},
    {What::pulp, {"*pulpa, *zahnmark"}},
    {What::precious,
     {"*nerv, *nerven, *nervs, *nervus, *nervenwurzel, *nervenwurzeln, *nervenkanal, *nervkanal",
      "*hirn, *gehirn, *kleinhirn, *großhirn, *hirnstamm, *stammhirn, *hirnhaut, *hirnhäute",
      "*rückenmark, *auge, *augen, *augapfel, *augäpfel, *schnecke, *hörschnecke, *innenohr",
      "*labyrinth, *bogengang, *bogengänge, *vorhof, *gleichgewichtsorgan, innerer gehörgang",
      "inneren gehörgang*, gehörgang innen, gehörgang innerer, *mandibularkanal, *mandibulakanal",
      "*unterkieferkanal, *fazialiskanal, *facialiskanal, *spinalkanal, *wirbelkanal, *duralsack",
      "*orbita, *augenhöhle, *hypophyse, *liquor, *paukensaite, *rundes fenster, *durasack"}},
    {What::vessel,
     {"*arterie, *arterien, *vene, *venen, *gefäß, *gefäße, *gefäss, *gefässe, ader, adern",
      "*schlagader, *blutader, *hirnsinus, *blutleiter, *aorta, *bulbus jugul*"}},
    {What::air,
     {"*höhle, *höhlen, *gehörgang, *gehörgänge, *zelle, *zellen, *mittelohr, luft, *luftweg*",
      "*atemweg*, *luftröhre, *rachen, hintergrund, *ohrtrompete, ohrtube"}},

    // Swedish
    {What::hard,
     {"*ben, *benet, *käke, *käken, *käkben, *tand, *tanden, *tänder, *tänderna, *skalle, *skallen",
      "*kranium, *kota, *kotor, *kotan, *revben, *emalj, *emaljen, *tandrot, *tandrötter, *skruv, "
      "*skruvar",
      "*utskott, *bäcken, *vägg, *fyllning, *skallbas"}},
    {What::marrow, {"*benmärg, *benmärgen"}},
    {What::ossicle, {"*hörselben, *hörselbenen, hammaren, hammare, städ, städet, *stigbygel*"}},
    {What::soft,
     {"*kanalen, *kanaler, hud, huden, *muskler, *muskeln, *brosk, *diskus, *ligament, *sena",
      "*senor, *vävnad, *mjukdel*, *tunga, *tungan, *körtel, *körtlar, *käkled, *käkleden, "
      "*tandkött*",
      "*slemhinna, *slemhinnan, *trumhinna, *trumhinnan, *hinna, *hinnan, *läpp, *blod, *lunga"}},
    {What::precious,
     {"*nerven, *nerver, *nerverna, *nervrot, *nervrötter, *nervkanalen, *hjärna, *hjärnan",
      "*lillhjärna*, *hjärnstam*, *hjärnhinna, *hjärnhinnan, *hjärnhinnor, *hårda hjärnhinnan",
      "*ryggmärg, *ryggmärgen, *öga, *ögat, *ögon, *ögonen, *snäcka, *snäckan, *innerörat",
      "*inneröra, *båggång, *båggångar, *båggångarna, inre hörselgång*, inre örongång*, "
      "*balansorgan",
      "*mandibularkanalen, *underkäkskanalen, *underkäkskanal, *ryggmärgskanal*, *ögonhåla*"}},
    {What::vessel,
     {"*artär, *artären, *artärer, ven, vener, venen, *halsven, *halsvenen, *blodkärl",
      "*kärl, *kärlen, *pulsåder, åder"}},
    {What::air,
     {"*håla, *hålan, *hålor, *hörselgång, *hörselgången, *hörselgångar, *örongång, *celler",
      "*mellanöra, *mellanörat, luft*, *luftväg*, *luftstrup*, *svalg*, bakgrund, *cellerna"}},

    // French
    {What::hard,
     {"^dent, ^dents, ^mâchoire, mandibule, ^crâne, vertèbre*, ^rocher",
      "^émail, ^ivoire, ^couronne, ^vis, osseux, osseuse, ^côte, ^côtes, ^paroi, ^racine, ^base",
      "^apophyse, ^mastoïde, ^molaire, ^bassin, ^fémur, ^lame, ^os"}},
    {What::spongy, {"^os spongieux, spongieux"}},
    {What::marrow, {"^moelle, ^moelle osseuse"}},
    {What::ossicle, {"^osselet, ^osselets, ^marteau, ^enclume, ^étrier"}},
    {What::soft,
     {"^canal *, ^canaux, ^conduit, ^peau, ^muscle *, ^muscles, ^graisse, ^cartilage *, ^disque",
      "^disques, ^ligament *, ^tendon *, ^membrane, ^muqueuse, ^gencive*, ^langue, ^glande*",
      "^articulation, ^tympan, ^tissu, ^tissus, ^tumeur, ^kyste, ^sang, ^lèvre*, ^coeur, ^cœur",
      "^poumon*, ^foie, ^foramen, ^oesophage, ^cornet*, ^conduit"}},
    {What::pulp, {"^pulpe*"}},
    {What::precious,
     {"^nerf, ^nerfs, ^dure mère, ^duremère, ^méninge*, ^cerveau, ^encéphale, ^cervelet",
      "^tronc cérébral, ^moelle épinière, ^œil, ^oeil, ^yeux, ^cochlée, ^limaçon, ^labyrinthe",
      "^vestibule, ^canaux semi circulaires, ^canaux semicirculaires, ^canal semi circulaire",
      "^canal semicirculaire, ^conduit auditif interne, ^méat auditif interne, ^oreille interne",
      "^méat acoustique interne, ^conduit acoustique interne, ^canal mandibulaire, ^canal dentaire",
      "^canal alvéolaire, ^canal facial, ^canal optique, ^canal rachidien, ^canal vertébral",
      "^orbite*, ^corde du tympan, ^aqueduc*, ^globe oculaire, ^hypophyse, ^ganglion, ^canal du "
      "nerf",
      "^racine nerveuse, ^sac dural, ^liquide céphalo*"}},
    {What::vessel,
     {"^artère, ^artères, ^veine, ^veines, ^vaisseau, ^vaisseaux, ^carotide, ^jugulaire, ^sinus",
      "^golfe, ^canal carotidien, ^aorte"}},
    {What::air,
     {"^conduit auditif externe, ^méat auditif externe, ^conduit auditif, ^caisse du tympan",
      "^méat acoustique externe, ^conduit acoustique externe, ^cellule*, ^cavité, ^fosse nasale",
      "^fosses nasales, ^oreille moyenne, ^voie aérienne, ^voies aériennes, ^trachée, ^pharynx",
      "^sinus frontal*, ^sinus maxillaire*, ^sinus sphéno*, ^sinus ethmo*, ^arrière plan, ^fond"}},

    // Spanish
    {What::hard,
     {"^hueso, ^huesos, ^diente, ^dientes, ^muela*, mandíbula, maxilar, ^cráneo, vértebra*",
      "^peñasco, ^esmalte, ^dentina, ^corona, ^implante*, ^tornillo*, óseo, ósea, ^costilla*",
      "^pared, ^raíz, ^apófisis, ^mastoides, ^molar*, ^base, ^lámina, ^cemento, ^pelvis, ^fémur"}},
    {What::spongy, {"^hueso esponjoso, ^hueso trabecular, esponjoso"}},
    {What::marrow, {"^médula, ^médula ósea"}},
    {What::ossicle, {"^huesecillo*, ^martillo, ^yunque, ^estribo"}},
    {What::soft,
     {"^canales, ^conducto, ^conductos, ^piel, ^músculo*, ^grasa, ^cartílago*, ^disco*, ^encía*",
      "^ligamento*, ^tendón*, ^membrana, ^mucosa, ^lengua, ^glándula*, ^articulación, ^tímpano",
      "^tejido*, ^tumor, ^quiste, ^sangre, ^labio*, ^corazón, ^pulmón*, ^hígado, ^foramen, "
      "^agujero",
      "^cornete*, ^esófago"}},
    {What::pulp, {"^pulpa"}},
    {What::precious,
     {"^nervio, ^nervios, ^duramadre, ^dura madre, ^meninge*, ^cerebro, ^encéfalo, ^cerebelo",
      "^tronco cerebral, ^tronco encefálico, ^médula espinal, ^ojo, ^ojos, ^cóclea, ^caracol",
      "^laberinto, ^vestíbulo, ^conductos semicirculares, ^conducto semicircular",
      "^canales semicirculares, ^canal semicircular, ^conducto auditivo interno, ^oído interno",
      "^meato auditivo interno, ^meato acústico interno, ^conducto dentario, ^conducto mandibular",
      "^conducto alveolar, ^canal mandibular, ^canal dentario, ^canal alveolar, ^canal facial",
      "^canal óptico, ^conducto raquídeo, ^canal vertebral, ^canal espinal, ^órbita*, ^cuerda del "
      "tímpano, ^acueducto, ^globo ocular, ^hipófisis, ^ganglio*, ^raíz nerviosa, ^saco dural"}},
    {What::vessel,
     {"^arterias, ^venas, ^vaso, ^vasos, ^seno, ^senos, ^carótida, ^yugular, ^golfo, ^canal "
      "carotídeo"}},
    {What::air,
     {"^conducto auditivo externo, ^meato auditivo externo, ^conducto auditivo, ^caja timpánica",
      "^meato acústico externo, ^caja del tímpano, ^celda*, ^celdilla*, ^cavidad, ^fosa nasal",
      "^fosas nasales, ^oído medio, ^vía aérea, ^vías aéreas, ^tráquea, ^faringe, ^aire",
      "^seno maxilar*, ^seno frontal*, ^seno esfenoid*, ^seno etmoid*, ^senos paranasales, ^fondo",
      "^senos maxilares, ^senos frontales"}},

    // SNOMED-CT, as 3D Slicer writes them
    {What::hard,
     {"sct 272673000, sct 91609006, sct 70925003, sct 89546000, sct 113197003",
      "sct 59066005, sct 13881006, sct 51299004, sct 661005, sct 60911003"}},
    {What::soft, {"sct 39937001, sct 21974007, sct 53620006"}},
    {What::precious, {"sct 12738006, sct 2748008, sct 81745001, sct 56052001, sct 361078006"}},
    {What::vessel, {"sct 69105007, sct 86117002, sct 85234005, sct 15825003"}},
    {What::air,
     {"sct 84301002, sct 15924003, sct 55060009, sct 54215007, sct 24999009",
      "sct 25342003, sct 44567001"}},
};
// NOLINTEND(bugprone-suspicious-missing-comma)

// Words that say only which one, or nothing.
constexpr auto kFillers = std::to_array<std::string_view>(
    {"left",    "right",     "l",       "r",        "li",     "re",       "lh",     "rh",
     "links",   "rechts",    "linke",   "rechte",   "linker", "rechter",  "linkes", "rechtes",
     "vanster", "hoger",     "vanstra", "hogra",    "gauche", "droit",    "droite", "izquierdo",
     "derecho", "izquierda", "derecha", "sinister", "dexter", "sinistra", "dextra", "sinistrum",
     "dextrum", "sin",       "dx",      "segment",  "label",  "mask",     "the",    "der",
     "die",     "das",       "le",      "la",       "les",    "el",       "los",    "las",
     "of",      "de",        "du",      "des",      "del",    "und",      "and",    "och",
     "upper",   "lower",     "den",     "d"});

// What comes after one of these says where the thing is, not what it is.
constexpr auto kPrepositions =
    std::to_array<std::string_view>({"of", "von", "vom", "im", "in", "des", "av", "i", "near"});

bool is_filler(const std::string& word) {
  return std::find(kFillers.begin(), kFillers.end(), word) != kFillers.end();
}

// The number of a tooth, a vertebra or a nerve.
bool is_number(const std::string& word) {
  return (word.size() < 4 && word.find_first_not_of("0123456789") == std::string::npos) ||
         (word.size() > 1 && word.find_first_not_of("ivx") == std::string::npos);
}

bool says_nothing(const std::string& word) { return is_filler(word) || is_number(word); }

// One character of the name in plain ASCII; n: how many bytes it takes.
std::string_view plain_character(std::string_view text, std::size_t& n) {
  struct Plain {
    std::string_view from, to;
  };
  static constexpr auto kPlain = std::to_array<Plain>(
      {{"ä", "a"}, {"Ä", "a"}, {"ö", "o"}, {"Ö", "o"}, {"ü", "u"}, {"Ü", "u"}, {"ß", "ss"},
       {"å", "a"}, {"Å", "a"}, {"é", "e"}, {"É", "e"}, {"è", "e"}, {"È", "e"}, {"ê", "e"},
       {"Ê", "e"}, {"ë", "e"}, {"à", "a"}, {"À", "a"}, {"â", "a"}, {"Â", "a"}, {"á", "a"},
       {"Á", "a"}, {"í", "i"}, {"Í", "i"}, {"î", "i"}, {"Î", "i"}, {"ï", "i"}, {"Ï", "i"},
       {"ó", "o"}, {"Ó", "o"}, {"ô", "o"}, {"Ô", "o"}, {"ò", "o"}, {"ú", "u"}, {"Ú", "u"},
       {"û", "u"}, {"Û", "u"}, {"ù", "u"}, {"ñ", "n"}, {"Ñ", "n"}, {"ç", "c"}, {"Ç", "c"},
       {"ø", "o"}, {"Ø", "o"}, {"æ", "a"}, {"Æ", "a"}, {"œ", "o"}, {"Œ", "o"}, {"ã", "a"}});
  for (const Plain& one : kPlain)
    if (text.substr(0, one.from.size()) == one.from) {
      n = one.from.size();
      return one.to;
    }
  // an accent of its own (U+0300 to U+036F), after its letter
  if (text.size() > 1 && (text[0] == '\xCC' || text[0] == '\xCD')) {
    n = 2;
    return "";
  }
  n = 1;
  return " ";
}

// ae, oe and ue are the umlauts in letters that everybody has, and Latin endings
void join_umlauts(std::string& word) {
  std::string out;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] == 'e' && !out.empty() &&
        (out.back() == 'a' || out.back() == 'o' || out.back() == 'u') &&
        (i < 2 || (word[i - 2] != 'q' && word[i - 2] != 'a')))
      continue;
    out += word[i];
  }
  word = std::move(out);
}

std::vector<std::string> split(std::string_view name, std::string_view keep) {
  std::vector<std::string> out;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) {
      join_umlauts(word);
      out.push_back(std::move(word));
    }
    word.clear();
  };
  char before = ' ';
  for (std::size_t i = 0; i < name.size();) {
    const char c = name[i];
    std::size_t n = 1;
    const bool digit = c >= '0' && c <= '9', lower = c >= 'a' && c <= 'z',
               upper = c >= 'A' && c <= 'Z';
    const bool was_digit = before >= '0' && before <= '9',
               was_lower = before >= 'a' && before <= 'z';
    if ((upper && was_lower) || (digit != was_digit && (digit || lower || upper))) end();
    if (digit || lower || keep.find(c) != std::string_view::npos)
      word += c;
    else if (upper)
      word += static_cast<char>(c - 'A' + 'a');
    else if (static_cast<unsigned char>(c) < 0x80)
      end();
    else if (const std::string_view plain = plain_character(name.substr(i), n); plain != " ")
      word += plain;
    before = static_cast<unsigned char>(c) < 0x80 ? c : 'x';
    i += n;
  }
  end();
  return out;
}

struct Phrase {
  std::vector<std::string> words;
  What what = What::hard;
  bool first = false;
};

const std::vector<Phrase>& phrases() {
  static const std::vector<Phrase> all = [] {
    std::vector<Phrase> out;
    for (const Rows& rows : kTable)
      for (const std::string_view line : rows.phrases)
        for (std::size_t at = 0; at < line.size();) {
          const std::size_t end = std::min(line.find(',', at), line.size());
          Phrase phrase{split(line.substr(at, end - at), "*"), rows.what, false};
          phrase.first = line.substr(at, end - at).find('^') != std::string_view::npos;
          std::erase_if(phrase.words, is_filler);
          if (!phrase.words.empty()) out.push_back(std::move(phrase));
          at = end + 1;
        }
    return out;
  }();
  return all;
}

// How far into the word the pattern's letters reach; 0: it does not match. "*" alone matches words
// of three letters or more.
std::size_t reach(const std::string& word, const std::string& pattern) {
  if (pattern == "*") return word.size() >= 3 && word[0] >= 'a' && word[0] <= 'z' ? word.size() : 0;
  const bool open = pattern.front() == '*', on = pattern.size() > 1 && pattern.back() == '*';
  const std::string_view core = std::string_view(pattern).substr(
      open ? 1 : 0, pattern.size() - (open ? 1 : 0) - (on ? 1 : 0));
  // a star in the middle ("aqu*ductus") needs both ends
  if (const std::size_t star = core.find('*'); star != std::string_view::npos) {
    const std::string_view head = core.substr(0, star), tail = core.substr(star + 1);
    return word.size() >= head.size() + tail.size() && word.starts_with(head) &&
                   word.ends_with(tail)
               ? word.size()
               : 0;
  }
  if (!open && !on) return word == core ? word.size() : 0;
  if (!open) return word.starts_with(core) ? core.size() : 0;
  if (!on) return word.ends_with(core) ? word.size() : 0;
  const std::size_t at = word.rfind(core);
  return at == std::string::npos ? 0 : at + core.size();
}

struct Hit {
  const Phrase* phrase = nullptr;
  std::size_t from = 0, count = 0, reach = 0, letters = 0;
};

bool better(const Hit& a, const Hit& b) {
  if (a.count != b.count) return a.count > b.count;
  if (a.reach != b.reach) return a.reach > b.reach;
  if (a.letters != b.letters) return a.letters > b.letters;
  return a.phrase->first && !b.phrase->first;  // the same word in two languages
}

// What the words say, from the first to the last: the best phrases that do not overlap.
std::vector<Hit> hits(const std::vector<std::string>& words) {
  std::vector<Hit> all;
  for (const Phrase& phrase : phrases())
    for (std::size_t at = 0; at + phrase.words.size() <= words.size(); ++at) {
      Hit hit{&phrase, at, phrase.words.size(), 0, 0};
      bool fits = true;
      for (std::size_t w = 0; w < hit.count && fits; ++w) {
        const std::string& word = words[at + w];
        hit.reach = reach(word, phrase.words[w]);
        if (hit.reach == 0 && word.size() > 4 && word.back() == 's')  // plural, genitive
          hit.reach = reach(word.substr(0, word.size() - 1), phrase.words[w]);
        hit.letters += phrase.words[w].size();
        fits = hit.reach > 0;
      }
      // "N. facialis": a letter alone counts only at the beginning
      if (fits && hit.count == 2 && phrase.words[1] == "*") {
        fits = at == 0;
        hit.count = 1;
      }
      if (fits) all.push_back(hit);
    }
  std::sort(all.begin(), all.end(), better);
  std::vector<Hit> out;
  std::vector<bool> taken(words.size());
  for (const Hit& hit : all) {
    bool free = true;
    for (std::size_t w = 0; w < hit.count; ++w) free = free && !taken[hit.from + w];
    if (!free) continue;
    for (std::size_t w = 0; w < hit.count; ++w) taken[hit.from + w] = true;
    out.push_back(hit);
  }
  std::sort(out.begin(), out.end(), [](const Hit& a, const Hit& b) { return a.from < b.from; });
  return out;
}

TissueKind kind_of(What what) {
  switch (what) {
    case What::hard:
    case What::region:
    case What::spongy:
    case What::marrow:
    case What::ossicle:
      return TissueKind::solid;
    case What::soft:
    case What::pulp:
    case What::precious:
    case What::vessel:
      return TissueKind::soft;
    case What::air:
      return TissueKind::air;
  }
  return TissueKind::solid;
}

}  // namespace

std::vector<std::string> plain_words(std::string_view name) { return split(name, ""); }

NamedTissue tissue_named(std::string_view name) {
  constexpr std::size_t kLongest = 256;  // of a name [byte]; no structure has a longer one
  std::vector<std::string> words = plain_words(name.substr(0, kLongest));
  const auto preposition =
      std::find_first_of(words.begin(), words.end(), kPrepositions.begin(), kPrepositions.end());
  std::vector<std::string> front(words.begin(), preposition);
  std::erase_if(front, says_nothing);
  std::erase_if(words, says_nothing);
  std::vector<Hit> found = hits(front);
  if (found.empty())
    found = hits(words);
  else
    words = std::move(front);
  NamedTissue out;
  if (found.empty()) return out;
  out.known = true;
  const auto is = [](What what) {
    return [what](const Hit& hit) { return hit.phrase->what == what; };
  };
  const auto has = [&](What what) { return std::any_of(found.begin(), found.end(), is(what)); };
  if (!std::all_of(found.begin(), found.end(), is(What::region)))
    std::erase_if(found, is(What::region));
  const auto any = [&](TissueKind kind) {
    return std::any_of(found.begin(), found.end(),
                       [&](const Hit& hit) { return kind_of(hit.phrase->what) == kind; });
  };
  const Hit &first = found.front(), &last = found.back();
  if (first.from == 0 && first.phrase->first)
    out.kind = kind_of(first.phrase->what);
  else if (last.from + last.count == words.size())
    out.kind = kind_of(last.phrase->what);
  else
    out.kind = any(TissueKind::air)     ? TissueKind::air
               : any(TissueKind::solid) ? TissueKind::solid
                                        : TissueKind::soft;
  if (out.kind == TissueKind::air) return out;
  out.spare = has(What::precious) || has(What::vessel) || has(What::ossicle);
  if (out.kind == TissueKind::soft && has(What::vessel))
    out.bleeds = 1;
  else if (has(What::marrow) || has(What::pulp))
    out.bleeds = kMarrowBleeds;
  else if (out.kind == TissueKind::solid && has(What::spongy))
    out.bleeds = kSpongyBleeds;
  return out;
}

}  // namespace burr::importing
