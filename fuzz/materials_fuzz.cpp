// The table of materials (TOML), and the constants that tissues get.
#include "burr/importing/materials.h"

#include <cmath>

#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  const std::string_view text = fuzz::text_of({data, size});
  const auto read = importing::parse_materials(text, "a.toml", importing::built_in_materials());
  fuzz::look_at_error(read);
  if (!read) return 0;
  for (const importing::Material& material : read->all)
    for (const importing::MaterialField& field : importing::material_fields())
      if (const auto& c = material.*(field.place))
        fuzz::must(c->value > 0 && c->low >= 0 && c->low <= c->value && c->value <= c->high &&
                       std::isfinite(c->high) && !c->source.empty(),
                   "a constant lies in its range and has a source");
  volume::TissueTable table;
  for (const char* name : {"bone", "enamel", "caries", "vein"}) {
    volume::Tissue tissue;
    tissue.name = name;
    read->apply_material(tissue);
    table.tissues.push_back(tissue);
  }
  fuzz::look_at(table);
  fuzz::must(importing::parse_materials(importing::materials_toml(read->all), "b.toml", {}).ok(),
             "what is written is read");
  return 0;
}
