/* The header as a C compiler sees it, and a host that walks points with it: usage c_interface_test
 * PARAMETERS.json */
#include <grainlaw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                             \
    }                                                                         \
  } while (0)

enum { most = 64, count = 10 };

static double entry(const grainlaw_law* law, const double* state, const char* name) {
  const int index = grainlaw_state_index(law, name);
  if (index >= 0) return state[index];
  fprintf(stderr, "no state entry %s\n", name);
  ++failures;
  return 0;
}

/* Begins a point at nu. */
static int begin(grainlaw_context* context, double nu, double* state, size_t length) {
  const char* const names[] = {"nu"};
  return grainlaw_start(context, 1, names, &nu, state, length);
}

/* On D2 at nu = 0.711: elastic at first (Eqs. 4.11, 4.15), saturated in the end (Table 2.2), and elastic
 * again at the reversal. */
static void check_plane_shear(const grainlaw_law* law, grainlaw_context* context) {
  const double e = 1e-4 / sqrt(3), forth[6] = {-e, e, 0, 0, 0, 0}, back[6] = {e, -e, 0, 0, 0, 0};
  const double rest[6] = {0, 0, 0, 0, 0, 0};
  double state[most], stress[6], tangent[36];
  const size_t length = grainlaw_state_length(law);
  int i;
  CHECK(begin(context, 0.711, state, length) == GRAINLAW_OK);
  CHECK(grainlaw_update(context, state, length, rest, stress, tangent) == GRAINLAW_OK);
  CHECK(stress[0] == stress[1] && stress[1] == stress[2] && stress[5] == 0);
  CHECK(fabs(tangent[0] - tangent[1] - 0.4279 * 0.3607) < 1e-4);  /* G_oct = B (G/B)_ini */
  CHECK(fabs((tangent[0] + 2 * tangent[1]) / 3 - 0.4279) < 1e-4); /* B */
  CHECK(fabs(tangent[35] - 0.4279 * 0.3607) < 1e-4);              /* shear xy, off the axis */
  for (i = 0; i < 4000; ++i)
    CHECK(grainlaw_update(context, state, length, forth, stress, NULL) == GRAINLAW_OK);
  CHECK(fabs(entry(law, state, "sigma_dev") / entry(law, state, "P") - 0.1669) < 1e-3);
  CHECK(fabs(entry(law, state, "F_dev") - 0.1238) < 1e-3);
  CHECK(fabs(entry(law, state, "eps_dev") - 0.4) < 1e-10);
  CHECK(stress[1] > stress[2] && stress[2] > stress[0]);
  CHECK(grainlaw_update(context, state, length, forth, stress, tangent) == GRAINLAW_OK);
  CHECK(fabs(tangent[0] - tangent[1]) < 1e-3); /* plastic */
  CHECK(grainlaw_update(context, state, length, back, stress, tangent) == GRAINLAW_OK);
  CHECK(tangent[0] - tangent[1] > 0.05); /* elastic */
}

static void check_refusals(const grainlaw_law* law, grainlaw_context* context) {
  const double off[6] = {0, 0, 0, 0, 1e-4, 0};
  double state[most], before[most], stress[6] = {7, 7, 7, 7, 7, 7};
  const size_t length = grainlaw_state_length(law);
  CHECK(begin(context, 2, state, length) == GRAINLAW_BAD_ARGUMENT);
  CHECK(strstr(grainlaw_message(context), "nu: must be > 0 and < 1, got 2") != NULL);
  CHECK(begin(context, 0.6, state, length) == GRAINLAW_UNJAMMED);
  CHECK(begin(context, 0.7, state, length) == GRAINLAW_OK);
  memcpy(before, state, sizeof state);
  CHECK(grainlaw_update(context, state, length, off, stress, NULL) == GRAINLAW_NOT_COAXIAL);
  CHECK(memcmp(before, state, length * sizeof *state) == 0 && stress[0] == 7);
  CHECK(strlen(grainlaw_message(context)) > 0);
  CHECK(grainlaw_update(context, state, length - 1, off, stress, NULL) == GRAINLAW_BAD_ARGUMENT);
  CHECK(grainlaw_update(context, NULL, length, off, stress, NULL) == GRAINLAW_BAD_ARGUMENT);
  CHECK(grainlaw_update(NULL, state, length, off, stress, NULL) == GRAINLAW_BAD_ARGUMENT);
}

static void check_many(const grainlaw_law* law, grainlaw_context* context) {
  double states[count * most], strains[6 * count], stresses[6 * count], tangents[36 * count];
  int statuses[count];
  grainlaw_outcome outcome;
  size_t i;
  for (i = 0; i < count; ++i) {
    CHECK(begin(context, 0.7, states + i * most, grainlaw_state_length(law)) == GRAINLAW_OK);
    memset(strains + 6 * i, 0, 6 * sizeof *strains);
    strains[6 * i] = -1e-4 * (double)i;
    strains[6 * i + 1] = 1e-4 * (double)i;
  }
  strains[6 * 7 + 4] = 1;
  CHECK(grainlaw_update_many(context, count, states, most, strains, stresses, tangents, 2, statuses,
                             &outcome) == GRAINLAW_NOT_COAXIAL);
  CHECK(outcome.failed == 1 && outcome.first == 7 && outcome.unjammed == 0);
  CHECK(strncmp(grainlaw_message(context), "point 7: ", 9) == 0);
  CHECK(statuses[6] == GRAINLAW_OK && statuses[7] == GRAINLAW_NOT_COAXIAL);
  CHECK(stresses[6 * 9 + 1] > stresses[6 * 8 + 1] && stresses[6 * 8 + 1] > stresses[1]);
}

int main(int argc, char** argv) {
  grainlaw_settings settings = GRAINLAW_SETTINGS;
  grainlaw_law* law = NULL;
  grainlaw_context* context = NULL;
  char message[256] = "";
  CHECK(argc == 2 && grainlaw_axis("d2", settings.axis) == GRAINLAW_OK);
  CHECK(grainlaw_law_from_file("no.json", &settings, &law, message, sizeof message) == GRAINLAW_BAD_INPUT);
  CHECK(law == NULL && strcmp(message, "no.json: no such file") == 0);
  CHECK(grainlaw_law_from_file(argv[1], &settings, &law, message, sizeof message) == GRAINLAW_OK);
  CHECK(grainlaw_context_create(law, &context) == GRAINLAW_OK);
  if (!context) return EXIT_FAILURE;
  CHECK(grainlaw_state_length(law) <= most && grainlaw_state_version() == 2);
  CHECK(strcmp(grainlaw_status_text(GRAINLAW_OK), "ok") == 0 && strlen(grainlaw_version()) >= 5);
  check_plane_shear(law, context);
  check_refusals(law, context);
  check_many(law, context);
  grainlaw_context_destroy(context);
  grainlaw_law_destroy(law);
  return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
