/* A plug-in for Boltwright without hardware, to start from: one arm that is a mass on a spring. Each call of
   exchange() is a millisecond in its life. The text of sample_arm.conf beside it, such as "400", is the
   stiffness of the spring in N/m. */
#include <boltwright_arm.h>
#include <stdlib.h>
#include <string.h>

#define MASS 0.5      /* kg */
#define DAMPING 25.0  /* N.s/m */
#define STIFFNESS 300 /* N/m, without a .conf file */
#define PERIOD 0.001  /* s */

struct bw_arm {
    double stiffness;
    double position[3], velocity[3];
    int enabled;
};

/* One arm a process is ever open. */
static struct bw_arm arm;
static const char* error = "";

static int count(void) { return 1; }

static struct bw_arm* open_arm(int index, const char* config) {
    if (index != 0) {
        error = "there is only one arm";
        return NULL;
    }
    memset(&arm, 0, sizeof arm);
    arm.stiffness = config[0] != '\0' ? strtod(config, NULL) : STIFFNESS;
    if (!(arm.stiffness >= 1.0 && arm.stiffness <= 1e5)) {
        error = "the .conf file has no stiffness from 1 to 100000 N/m";
        return NULL;
    }
    return &arm;
}

static int info(struct bw_arm* a, struct bw_arm_info_v1* about) {
    (void)a;
    strcpy(about->name, "mass on a spring");
    about->axes = BW_ARM_FORCE_X | BW_ARM_FORCE_Y | BW_ARM_FORCE_Z;
    about->rate = 1000.0;
    about->max_force = 10.0;
    about->max_stiffness = 2000.0;
    about->max_damping = 10.0;
    about->half_workspace[0] = about->half_workspace[1] = about->half_workspace[2] = 0.1;
    about->buttons = 1;
    return BW_ARM_DONE;
}

/* It knows its position from the start. */
static int calibrate(struct bw_arm* a, int may_move) {
    (void)a;
    (void)may_move;
    return BW_ARM_DONE;
}

static int enable(struct bw_arm* a, int on) {
    a->enabled = on;
    return BW_ARM_DONE;
}

static int exchange(struct bw_arm* a, const struct bw_arm_command_v1* command,
                    struct bw_arm_state_v1* state) {
    int i;
    for (i = 0; i < 3; ++i) {
        const double motor = a->enabled ? command->force[i] : 0.0;
        const double force = motor - a->stiffness * a->position[i];
        /* Implicit in the damping. */
        a->velocity[i] = (a->velocity[i] + PERIOD / MASS * force) / (1.0 + PERIOD / MASS * DAMPING);
        a->position[i] += PERIOD * a->velocity[i];
        state->position[i] = a->position[i];
    }
    return BW_ARM_DONE;
}

static const char* last_error(struct bw_arm* a) {
    (void)a;
    return error;
}

static void close_arm(struct bw_arm* a) { a->enabled = 0; }

static const struct bw_arm_v1 functions = {sizeof functions, 0,      count,    open_arm,   info,
                                           calibrate,        enable, exchange, last_error, close_arm};

const struct bw_arm_v1* bw_arm_entry(uint32_t abi) { return abi == BW_ARM_ABI ? &functions : NULL; }
