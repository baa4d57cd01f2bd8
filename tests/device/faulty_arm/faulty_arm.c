/* The sample arm with faults: the file $FAULTY_ARM has the name of the one that it shows now. It can change
   at any time; without the file there is none. */
#define _GNU_SOURCE
#include <boltwright_arm.h>

const struct bw_arm_v1* sample_arm_entry(uint32_t abi);
#define bw_arm_entry sample_arm_entry
#include "../sample_arm/sample_arm.c"
#undef bw_arm_entry
#include <signal.h>
#include <stdio.h>
#include <sys/socket.h>
#include <unistd.h>

static int user_has_acted = 0, calibrations = 0;
static double last_force = 0.0; /* N, along x */

static int shows(const char* fault) {
    char now[32] = "";
    const char* path = getenv("FAULTY_ARM");
    FILE* file = path != NULL ? fopen(path, "r") : NULL;
    if (file == NULL) return 0;
    if (fgets(now, sizeof now, file) == NULL) now[0] = '\0';
    fclose(file);
    return strcmp(now, fault) == 0;
}

/* A file beside $FAULTY_ARM that the test reads. */
static FILE* observation(const char* name, const char* mode) {
    char path[4096];
    const char* fault = getenv("FAULTY_ARM");
    const char* slash = fault != NULL ? strrchr(fault, '/') : NULL;
    if (slash == NULL) return NULL;
    snprintf(path, sizeof path, "%.*s/%s", (int)(slash - fault), fault, name);
    return fopen(path, mode);
}

static void observe(const char* text) {
    FILE* file = observation("closing", "a");
    if (file == NULL) return;
    fputs(text, file);
    fclose(file);
}

/* Uses the connection to the program, which the plug-in has not opened. */
static void meddle(int disconnects) {
    int fd;
    for (fd = 3; fd < 32; ++fd) {
        if (disconnects)
            shutdown(fd, SHUT_RDWR);
        else
            send(fd, "nonsense", 8, MSG_NOSIGNAL);
    }
}

static void misbehave(const char* function) {
    char fault[32];
    snprintf(fault, sizeof fault, "crash in %s", function);
    if (shows(fault)) raise(SIGSEGV);
    snprintf(fault, sizeof fault, "exit in %s", function);
    if (shows(fault)) _exit(3);
    snprintf(fault, sizeof fault, "hang in %s", function);
    if (shows(fault))
        for (;;) pause();
}

static int faulty_count(void) {
    misbehave("count");
    if (shows("many")) return 1000;
    if (shows("unplugged")) return 0;
    error = "no\tUSB\xff"; /* a control character, and a byte that is no UTF-8 */
    return shows("no count") ? BW_ARM_ERROR : count();
}

static struct bw_arm* faulty_open(int index, const char* config) {
    misbehave("open");
    if (shows("unplugged")) {
        error = "the arm is unplugged";
        return NULL;
    }
    user_has_acted = calibrations = 0;
    return open_arm(index, config);
}

static int faulty_info(struct bw_arm* a, struct bw_arm_info_v1* about) {
    info(a, about);
    if (shows("infinite force")) about->max_force = 1.0 / 0.0;
    if (shows("negative torque")) about->max_torque = -1.0;
    if (shows("no stiffness")) about->max_stiffness = 0.0;
    if (shows("slow")) about->rate = 50.0;
    if (shows("late")) about->delay = 3;
    if (shows("no reach")) about->half_workspace[1] = 0.0;
    if (shows("buttons")) about->buttons = 33;
    if (shows("long name")) memset(about->name, 'x', sizeof about->name);
    if (shows("senses rotation")) about->flags = BW_ARM_SENSES_ROTATION;
    if (shows("senses gripper")) about->flags = BW_ARM_SENSES_GRIPPER;
    if (shows("input only")) about->axes = 0;
    if (shows("strong")) {
        about->axes = 63;
        about->max_force = 500.0;
        about->max_torque = 50.0;
        about->max_stiffness = 1e6;
        about->max_torsion = 1e3;
        about->max_damping = 1e3;
        about->max_angular_damping = 1e3;
        about->half_workspace[0] = 50.0;
        about->rate = 20000.0;
    }
    return BW_ARM_DONE;
}

static int faulty_calibrate(struct bw_arm* a, int may_move) {
    misbehave("calibrate");
    if (shows("must move") && !may_move) return BW_ARM_MUST_MOVE;
    if (shows("needs user")) {
        user_has_acted = 1;
        error = "put the pen into its holder";
        return BW_ARM_NEEDS_USER;
    }
    /* Only the process that has seen the user act knows its position. */
    if (shows("user acts") && !user_has_acted) return BW_ARM_ERROR;
    if (shows("busy") && ++calibrations < 5) return BW_ARM_BUSY;
    if (shows("busy for long") && ++calibrations < 80) return BW_ARM_BUSY; /* half a second has 50 calls */
    return shows("odd") ? 99 : calibrate(a, may_move);
}

static int faulty_enable(struct bw_arm* a, int on) {
    misbehave("enable");
    if (!on) observe(last_force == 0.0 ? "force 0, off, " : "a force, off, ");
    return enable(a, on);
}

static int faulty_exchange(struct bw_arm* a, const struct bw_arm_command_v1* command,
                           struct bw_arm_state_v1* state) {
    misbehave("exchange");
    last_force = command->force[0];
    if (last_force == 0.0 && shows("released")) {
        FILE* file = observation("released", "w");
        if (file != NULL) fclose(file);
    }
    if (shows("unplugged")) {
        error = "the arm is unplugged";
        return BW_ARM_ERROR;
    }
    if (shows("nonsense")) meddle(0);
    if (shows("closed connection")) {
        meddle(1);
        for (;;) pause();
    }
    if (shows("20 ms")) usleep(20000);
    if (shows("silent")) return BW_ARM_NO_SAMPLE;
    exchange(a, command, state);
    if (shows("NaN")) state->position[2] = 0.0 / 0.0;
    if (shows("far away")) state->position[0] = 1e30;
    if (shows("bad turn")) state->orientation[0] = 0.5;
    if (shows("senses rotation")) /* a quarter turn about z, of almost unit length */
        state->orientation[0] = state->orientation[3] = 0.7072;
    state->gripper = shows("NaN gripper") ? 0.0 / 0.0 : shows("wide gripper") ? 3.0 : 0.25;
    if (shows("all buttons")) state->buttons = 0xffffffffu;
    return BW_ARM_DONE;
}

static void faulty_close(struct bw_arm* a) {
    observe("close");
    close_arm(a);
}

static const struct bw_arm_v1 faulty = {
    sizeof faulty,   0,          faulty_count, faulty_open, faulty_info, faulty_calibrate, faulty_enable,
    faulty_exchange, last_error, faulty_close};

/* Tables that the program has to refuse. */
static const struct bw_arm_v1 short_table = {40, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const struct bw_arm_v1 empty_table = {sizeof empty_table, 0, 0, 0, 0, 0, 0, 0, 0, 0};

const struct bw_arm_v1* bw_arm_entry(uint32_t abi) {
    misbehave("bw_arm_entry");
    if (shows("old") || abi != BW_ARM_ABI) return NULL;
    if (shows("short")) return &short_table;
    return shows("empty") ? &empty_table : &faulty;
}
