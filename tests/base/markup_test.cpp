// Foreign text between tags.
#include "burr/base/markup.h"

#include <gtest/gtest.h>

namespace burr::base {
namespace {

TEST(Markup, NothingOfItIsMarkup) {
  EXPECT_EQ(markup_text("<b title=\"x\">a & b</b>"),
            "&lt;b title=&quot;x&quot;&gt;a &amp; b&lt;/b&gt;");
  EXPECT_EQ(markup_text("tooth \xc3\xa4 7"), "tooth \xc3\xa4 7");
  EXPECT_EQ(markup_text("a\x01\x1b[31m\tb\nc"), "a  [31m\tb\nc");
  EXPECT_EQ(markup_text(std::string_view("a\0b", 3)), "a b");
  EXPECT_EQ(markup_text(""), "");
}

}  // namespace
}  // namespace burr::base
