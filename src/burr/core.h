// burr/core.h - touching and cutting bone, without files, threads or a window: all that a program needs that
// has its own bone, its own hand and its own loop. Link burr::core, which needs the C++ library alone.
//
//     volume::Bone bone(...);  volume::IsoVertices surface(bone, ...);
//     device::PushedHand hand;                                  // or a device::Device of your own
//     tick::Servo servo(bone, surface, hand, settings);
//     const tick::TickRow& row = servo.tick(false);             // a thousand times a second
//
// samples/installed/core.cpp is a whole program. Sessions, recordings and files: sim/session.h and what
// stands beside it in docs/develop/architecture.md, with burr::burr.
#pragma once

#include "burr/base/progress.h"
#include "burr/device/device.h"
#include "burr/device/pushed_hand.h"
#include "burr/device/replayed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/rt/flags.h"
#include "burr/tick/command.h"
#include "burr/tick/rows.h"
#include "burr/tick/servo.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"
