// A libspnav.so.0 without daemon or cap: what the test set through fake_* comes out as events.
extern "C" {

struct FakeMotion {
  int type, axes[6];
  unsigned period;
  int* data;
};
struct FakeButton {
  int type, press, number;
};

static int fake_axes_now[6];
static int fake_moves, fake_button = -1, fake_opened, fake_absent;

void fake_move(const int* axes) {
  for (int n = 0; n < 6; ++n) fake_axes_now[n] = axes[n];
  fake_moves = 1;
}
void fake_press(int number) { fake_button = number; }
void fake_daemon(int there) { fake_absent = there == 0; }
int fake_open_count() { return fake_opened; }

int spnav_open() {
  if (fake_absent != 0) return -1;
  ++fake_opened;
  return 0;
}
int spnav_close() {
  --fake_opened;
  return 0;
}
int spnav_poll_event(void* event) {
  if (fake_button >= 0) {
    *static_cast<FakeButton*>(event) = {2, 1, fake_button};
    fake_button = -1;
    return 2;
  }
  if (fake_moves == 0) return 0;
  --fake_moves;
  FakeMotion* motion = static_cast<FakeMotion*>(event);
  motion->type = 1;
  for (int n = 0; n < 6; ++n) motion->axes[n] = fake_axes_now[n];
  motion->period = 8;
  motion->data = &motion->axes[0];
  return 1;
}
}
