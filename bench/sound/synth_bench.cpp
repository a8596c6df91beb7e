// bench/sound - the cost of a second of sound, in silence and with all sounds.
#include <benchmark/benchmark.h>

#include <vector>

#include "burr/sound/synth.h"

namespace {

using namespace burr;

void second_of_sound(benchmark::State& state) {
  sound::Synth synth;
  sound::SoundState heard;
  if (state.range(0) != 0) {
    heard.spindle_rad_s = 4'189;
    heard.cutting_nm = 3e-3;
    heard.removal_m3_s = 5e-9;
    heard.hardness_j_m3 = 1e9;
    heard.irrigated = true;
    heard.to_spare = 0;
  }
  std::vector<float> block(480);
  for (auto _ : state)
    for (int n = 0; n < 100; ++n) {
      heard.touching = n % 20 < 10;
      synth.update(heard);
      synth.make(block);
      benchmark::DoNotOptimize(block.data());
    }
}
BENCHMARK(second_of_sound)->ArgName("everything")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
