/* The law of grainlaw for hosts in C, or in anything that can call C: a strain increment in, stress and
 * tangent out, state owned by the caller. docs/c-interface.md has a whole program.
 *
 * What it cannot do: the law carries one axis of shear, chosen when it is made. Axes do not rotate, and an
 * increment that shears along another is refused (GRAINLAW_NOT_COAXIAL). Grains have no friction; nothing
 * depends on the rate.
 *
 * Tensors are six numbers: xx, yy, zz, yz, xz, xy. Unless the settings say otherwise, compression is positive
 * for strain and stress, and shears are components of the tensor, without a factor 2. Strain is logarithmic.
 * Stress is over k* = k/(2<r>): times grainlaw_stress_unit() it is in kPa.
 *
 * Nothing here prints, exits, or throws. Where a status is negative nothing has been changed: neither state
 * nor stress nor tangent. */
#ifndef GRAINLAW_H
#define GRAINLAW_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a function returns. */
enum {
  GRAINLAW_OK = 0,
  GRAINLAW_UNJAMMED = 1,      /* well, and the point carries no stress: P = 0 */
  GRAINLAW_FAILED = -1,       /* the increment could not be integrated, or memory is out */
  GRAINLAW_NOT_COAXIAL = -2,  /* the increment shears along another axis than the law's */
  GRAINLAW_BAD_ARGUMENT = -3, /* NULL, not finite, out of range, a state that is none */
  GRAINLAW_BAD_INPUT = -4     /* a parameter set that cannot be read, or lacks what the form needs */
};

/* A status in words; of a number that is no status, "unknown status". Never NULL. */
const char* grainlaw_status_text(int status);
/* "0.1.0". */
const char* grainlaw_version(void);

/* ---- The law ---- */

/* Parameters, form, tolerances and axis. It never changes once it is made: any number of threads may share
 * it. */
typedef struct grainlaw_law grainlaw_law;

/* How a law is made. Begin with GRAINLAW_SETTINGS, which sets all but the axis, and change what is to differ:
 *   grainlaw_settings settings = GRAINLAW_SETTINGS;
 *   grainlaw_axis("d2", settings.axis); */
typedef struct grainlaw_settings {
  size_t size;      /* sizeof(grainlaw_settings) of the header that the caller was compiled with */
  const char* form; /* "coupled" (Eq. 4.16), "memory", "reduced", "reduced_closed", "coupled_3_14"; terms past
                       the thesis after a plus: "coupled+energy" */
  double axis[6];   /* its deviator is the axis of shear; its length does not matter. A strain with a
                       positive projection on it has eps_dev > 0. Always compression positive, without
                       a factor 2 */
  double rtol, atol;        /* of the integration: error relative to the state's size, and where that is
                               smaller, absolute. > 0 */
  double coaxial_tolerance; /* in [0, 1]: what of an increment's deviator may lie off the axis, over
                               |eps_vol| + sqrt(3 J2) of the increment. It is dropped. At 1 every increment is
                               projected on the axis and none refused */
  int tension_positive;     /* not 0: strain and stress of the host are positive in tension. State entries
                               stay compression positive */
  int engineering_shear;    /* not 0: strains yz, xz, xy of the host are twice those of the tensor */
  int projected_tangent;    /* not 0: the tangent off the axis is 0; see grainlaw_update() */
} grainlaw_settings;

#define GRAINLAW_SETTINGS \
  { sizeof(grainlaw_settings), "coupled", {0, 0, 0, 0, 0, 0}, 1e-8, 1e-12, 1e-8, 0, 0, 0 }

/* The axis of a mode: "d2" (-1, 1, 0), y compresses and x extends; "uni" and "d3" (-1/2, -1/2, 1), z
 * compresses. */
int grainlaw_axis(const char* mode, double axis[6]);

/* Makes a law of a parameter set, PARAMETERS.json of docs/formats.md: its text, or the name of a file. On
 * failure *law is NULL and `message`, a buffer of `message_size` bytes that may be NULL, says why. */
int grainlaw_law_from_text(const char* text, const grainlaw_settings* settings, grainlaw_law** law,
                           char* message, size_t message_size);
int grainlaw_law_from_file(const char* file, const grainlaw_settings* settings, grainlaw_law** law,
                           char* message, size_t message_size);
/* NULL is allowed. Contexts of this law go on working. */
void grainlaw_law_destroy(grainlaw_law* law);

/* k* = k/(2<r>) of the material in the parameter set, kPa; NaN for NULL. */
double grainlaw_stress_unit(const grainlaw_law* law);

/* ---- The state of a point ---- */

/* An array of doubles that belongs to the caller: copied, stored and sent around at will. It may become
 * longer, and its entries may move, with another version of its layout, which stands in its first entry and
 * is checked; so ask for its length, and find entries by name. */
int grainlaw_state_version(void);
/* 0 for NULL. */
size_t grainlaw_state_length(const grainlaw_law* law);
/* The entries of version 2: version, nu, P, sigma_dev, F_dev, phi_J, jammed, eps_vol, eps_dev, phi_J_laws,
 * direction, S_I, S_F_I, s_dev_0, F_dev_0, eps_dev_0, phi_H, phi_max, phi_H_nu, memory_plus,
 * memory_minus, packed, phi_t (docs/c-interface.md).
 * NULL where there is none. */
const char* grainlaw_state_name(const grainlaw_law* law, size_t index);
/* -1 where there is no such entry. */
int grainlaw_state_index(const grainlaw_law* law, const char* name);

/* ---- The context: one per thread ---- */

/* What a thread needs to use a law: its last message, what it computed last, and where failures are written.
 */
typedef struct grainlaw_context grainlaw_context;

int grainlaw_context_create(const grainlaw_law* law, grainlaw_context** context);
/* NULL is allowed. */
void grainlaw_context_destroy(grainlaw_context* context);
/* What the last call with this context had to say; "" if nothing. Valid until the next one. */
const char* grainlaw_message(const grainlaw_context* context);

/* Increments that fail (GRAINLAW_FAILED, GRAINLAW_NOT_COAXIAL) are written to this file, each over the one
 * before it: `grainlaw replay FILE` does them again. NULL: no more. */
int grainlaw_context_replay_file(grainlaw_context* context, const char* file);

/* ---- Walking ---- */

/* Begins a point, as the `start` of a path: `count` values by name, out of nu (required), P, sigma_dev,
 * F_dev, phi_J and phi_max; what is not given comes from the parameter set. `length` is that of `state`.
 * Returns GRAINLAW_UNJAMMED where the point carries nothing; grainlaw_message() has warnings, if any. */
int grainlaw_start(grainlaw_context* context, size_t count, const char* const* names, const double* values,
                   double* state, size_t length);

/* The stress of a state: P on the diagonal and a deviator along the axis, whose sqrt(3 J2) is |sigma_dev|. */
int grainlaw_stress(grainlaw_context* context, const double* state, size_t length, double stress[6]);

/* Walks a point over an increment of logarithmic strain. `tangent`, if it is not NULL, receives at 6 i + j
 * the derivative of stress i by number j of the increment as it was written: the change of the stress is
 * tangent times increment, a product of a matrix and a vector with no factor to add. It is not symmetric, so
 * Fortran reads it transposed.
 * Along the axis and for volume it is exact, the derivative of what the step did. Off the axis no increment
 * is taken, so there is nothing to differentiate: there it is the stiffness of shear from the isotropic
 * state of this density, B (G/B)_ini (reduced forms: P beta_s s_max), that a host's matrix may be regular;
 * with projected_tangent it is 0. Where the point is unjammed all of it is 0. */
int grainlaw_update(grainlaw_context* context, double* state, size_t length, const double strain_increment[6],
                    double stress[6], double* tangent);

/* What came of many points. */
typedef struct grainlaw_outcome {
  size_t failed;   /* points whose status is negative: they are as before */
  size_t first;    /* the first of them */
  size_t unjammed; /* points that carry nothing now */
} grainlaw_outcome;

/* The same for `count` points on `threads` threads (>= 1). Point i has its state at states + i * stride
 * (stride >= grainlaw_state_length()), its increment at strain_increments + 6 * i, its stress at
 * stresses + 6 * i, and, unless these are NULL, its tangent at tangents + 36 * i and its status at
 * statuses[i]. In the form "coupled" blocks of 64 points of one history go through vectors where no tangent
 * is asked for and an increment is one step to the tolerance (rtol = 1e-8: d eps_dev up to 5e-5, 1e-6: 3e-4):
 * their answers are those of grainlaw_update() within the tolerance, and the same on any number of threads.
 * `outcome` may be NULL. Returns the status of the first point that failed, and its message and replay file;
 * else GRAINLAW_UNJAMMED where any point carries nothing, else GRAINLAW_OK. A bad argument of the call itself
 * changes nothing, statuses and outcome included. */
int grainlaw_update_many(grainlaw_context* context, size_t count, double* states, size_t stride,
                         const double* strain_increments, double* stresses, double* tangents, int threads,
                         int* statuses, grainlaw_outcome* outcome);

#ifdef __cplusplus
}
#endif

#endif
