/* A cycle of plane shear (D2), as a solver would drive it: usage d2_cycle PARAMETERS.json */
#include <grainlaw.h>
#include <stdio.h>
#include <stdlib.h>

static int give_up(const char* what, const char* message) {
  fprintf(stderr, "%s: %s\n", what, message);
  return EXIT_FAILURE;
}

int main(int argc, char** argv) {
  enum { legs = 3, steps = 4000 }; /* eps_dev to 0.4, to -0.4, and back to 0.4 */
  const char* given[] = {"nu"};
  const double nu[] = {0.711}, sqrt3 = 1.7320508075688772, deps_dev[legs] = {1e-4, -2e-4, 2e-4};
  double stress[6], tangent[36], *state;
  char message[256];
  grainlaw_law* law;
  grainlaw_context* context;
  grainlaw_settings settings = GRAINLAW_SETTINGS;
  size_t length;
  int leg, i, status;

  grainlaw_axis("d2", settings.axis);
  if (grainlaw_law_from_file(argc > 1 ? argv[1] : "", &settings, &law, message, sizeof message) < 0)
    return give_up("law", message);
  length = grainlaw_state_length(law);
  state = malloc(length * sizeof *state);
  if (!state || grainlaw_context_create(law, &context) < 0) return give_up("memory", "none left");
  if (grainlaw_start(context, 1, given, nu, state, length) < 0)
    return give_up("start", grainlaw_message(context));
  grainlaw_context_replay_file(context, "failed.json");

  for (leg = 0; leg < legs; ++leg) {
    const double e = deps_dev[leg] / sqrt3, increment[6] = {-e, e, 0, 0, 0, 0};
    for (i = 0; i < steps; ++i) {
      status = grainlaw_update(context, state, length, increment, stress, tangent);
      if (status < 0) return give_up(grainlaw_status_text(status), grainlaw_message(context));
    }
    printf("eps_dev %7.4f  P %.4f kPa  sxx %.4f kPa  syy %.4f kPa  F_dev %7.4f\n",
           state[grainlaw_state_index(law, "eps_dev")],
           state[grainlaw_state_index(law, "P")] * grainlaw_stress_unit(law),
           stress[0] * grainlaw_stress_unit(law), stress[1] * grainlaw_stress_unit(law),
           state[grainlaw_state_index(law, "F_dev")]);
  }
  grainlaw_context_destroy(context);
  grainlaw_law_destroy(law);
  free(state);
  return EXIT_SUCCESS;
}
