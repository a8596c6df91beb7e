#define BURR_KERNEL avx512
#include "rt/lanes_checks.inc"
