/* The deployed generator for training, many streams at once: a plain C interface, loaded by
 * training/pmg_train/references.py. No function throws; those that can fail return NULL or nonzero and
 * pmg_batch_error() says why. One handle, one thread at a time. */
#ifndef PMG_BATCH_H
#define PMG_BATCH_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct pmg_batch;  // NOLINT(readability-identifier-naming): a name of C

#define PMG_BATCH_API __attribute__((visibility("default")))

/* robot: its directory. variant: "pmg", "without_gco" or "single_gait". Streams differ by seed, seed + 1, ... */
PMG_BATCH_API struct pmg_batch* pmg_batch_create(const char* robot, const char* variant, int32_t streams, uint64_t seed,
                                                 int32_t threads);
PMG_BATCH_API void pmg_batch_destroy(struct pmg_batch* batch);
PMG_BATCH_API const char* pmg_batch_error(void);

/* Robot, row fields and observation layout as JSON; lives as long as the handle. */
PMG_BATCH_API const char* pmg_batch_description(const struct pmg_batch* batch);

/* Steps every stream by so many ticks. out[ticks][streams][row]; commands[ticks][streams][6], or NULL for random ones.
 */
PMG_BATCH_API int32_t pmg_batch_run(struct pmg_batch* batch, int32_t ticks, const float* commands, float* out);
PMG_BATCH_API void pmg_batch_reset(struct pmg_batch* batch);

/* The controller's observation of stream 0's last tick for this robot state; first != 0 forgets the history.
 * gyro[3] rad/s, quat_wxyz[4] of the IMU, q[joints] rad, dq[joints] rad/s, last_action[actions], out[observation size].
 */
PMG_BATCH_API int32_t pmg_batch_observe(struct pmg_batch* batch, int32_t first, const double* gyro,
                                        const double* quat_wxyz, const double* q, const double* dq,
                                        const float* last_action, float* out);

/* Files that the C++ programs read too, read and checked by the same code. JSON, or NULL where pmg_batch_error() is the line that pmg_sil
 * prints for that file. The text of each lives until the same function is called again in its thread. robot: its directory.
 */
PMG_BATCH_API const char* pmg_batch_randomization(const char* file);
PMG_BATCH_API const char* pmg_batch_motors(const char* robot, const char* file);
PMG_BATCH_API const char* pmg_batch_scenario(const char* file);

#ifdef __cplusplus
}
#endif
#endif
