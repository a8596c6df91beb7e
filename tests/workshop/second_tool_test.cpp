// The tool of the other hand in a picture, and what each kind of tool throws.
#include "burr/workshop/second_tool.h"

#include <gtest/gtest.h>

#include <array>

#include "burr/render/scene.h"
#include "burr/scenario/rack.h"
#include "burr/workshop/work_view.h"

namespace burr::workshop {
namespace {

using math::Vec3;

tool::ShapedTool of_rack(const char* name) {
  const auto tool = scenario::built_in_rack().get(name);
  EXPECT_TRUE(tool.ok());
  return {tool->name, tool->tool, tool->cutter};
}

tick::TickRow row_of(int number) {
  tick::TickRow row;
  row.hand.valid = true;
  row.hand.world_from_tool.q = math::Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));  // x to y
  row.contact.proxy = {1e-3, 2e-3, 3e-3};
  row.tool.number = number;
  row.tool.radius = 1.5e-3;
  row.ledger.removed = 5e-9;
  return row;
}

// Its own surface, made once; a tube is a rod; what is not there leaves nothing.
TEST(SecondTool, IsDrawnAsItIs) {
  render::Scene scene;
  SecondTool drawn;
  const tool::ShapedTool saw = of_rack("sagittal-saw");
  const tick::TickRow row = row_of(0);
  drawn.put(scene, &row, &saw.tool);
  ASSERT_TRUE(scene.beside.has_value());
  EXPECT_TRUE(scene.rods.empty());
  EXPECT_EQ(scene.beside->world_from_tool.p, row.contact.proxy);
  EXPECT_FALSE(scene.beside->look->cuts.vertices.empty());
  const auto look = scene.beside->look;
  drawn.put(scene, &row, &saw.tool);
  EXPECT_EQ(scene.beside->look, look);
  drawn.put(scene, nullptr, &saw.tool);
  EXPECT_FALSE(scene.beside.has_value());

  SecondTool tube;
  const tick::TickRow ball = row_of(-1);
  tube.put(scene, &ball, nullptr);
  EXPECT_FALSE(scene.beside.has_value());
  ASSERT_EQ(scene.rods.size(), 1U);
  EXPECT_EQ(scene.rods[0].radius, 1.5e-3);
  EXPECT_TRUE(sucks(ball));
  tube.put(scene, nullptr, nullptr);
  EXPECT_TRUE(scene.rods.empty());
}

TEST(WoundTick, SaysWhatTheToolThrows) {
  const std::array<tool::ShapedTool, 4> tools = {of_rack("flame"), of_rack("sagittal-saw"),
                                                 of_rack("osteotome"), of_rack("curette")};
  const auto tick = [&](int number) { return wound_tick(row_of(number), 1000, tools); };
  for (const int turns : {-1, 0, 7}) {  // a round burr, the flame, a number that is none
    EXPECT_EQ(tick(turns).dust, 1) << turns;
    EXPECT_EQ(tick(turns).stroke, Vec3::Zero()) << turns;
  }
  const Vec3 way = row_of(1).hand.world_from_tool.q * tools[1].cutter.way;
  EXPECT_EQ(tick(1).dust, 1);
  EXPECT_NEAR((tick(1).stroke - way).norm(), 0, 1e-12);
  for (const int edge : {2, 3}) {
    const math::Quat q = row_of(edge).hand.world_from_tool.q;
    EXPECT_EQ(tick(edge).dust, 0);
    EXPECT_TRUE(tick(edge).chips);
    const tool::ShapedTool& tool = tools[static_cast<std::size_t>(edge)];
    EXPECT_NEAR((tick(edge).forward - q * tool.cutter.way).norm(), 0, 1e-12);
    EXPECT_GT((q.conjugate() * tick(edge).edge).y(), 1e-3) << "half of the edge's width";
  }
  EXPECT_FALSE(tick(1).chips);
  EXPECT_EQ(tick(1).others, 0);
  tick::TickRow second = row_of(0);
  second.ledger.removed = 2e-9;
  EXPECT_EQ(wound_tick(row_of(-1), 1000, tools, &second).others, 2e-9);
}

}  // namespace
}  // namespace burr::workshop
