// Names of labels in XML, JSON and the lists of other programs, and what the names say.
#include "burr/io/read/label_lists.h"

#include "burr/importing/tissue_names.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const std::string_view text = fuzz::text_of({data, size});
  for (const auto& labels :
       {io::labels_in_xml(text), io::labels_in_json(text), io::labels_in_lut(text)}) {
    fuzz::must(labels.size() <= 4096, "labels are few");
    for (const io::Label& label : labels) {
      fuzz::must(label.value > 0, "a value is above 0");
      for (const float part : label.colour)
        fuzz::must(part >= 0 && part <= 1, "a colour is from 0 to 1");
      static_cast<void>(importing::tissue_named(label.name));
    }
  }
  const importing::NamedTissue says = importing::tissue_named(text);
  fuzz::must(says.known || says.kind == volume::TissueKind::solid, "an unknown name is solid");
  return 0;
}
