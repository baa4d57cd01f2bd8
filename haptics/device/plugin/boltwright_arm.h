/* The interface of plug-ins that add force-feedback arms to Boltwright. C99 or C++; needs no other header of
   Boltwright.

   A plug-in is a shared library NAME.so that exports bw_arm_entry(). Boltwright finds it in the folders of
   $BOLTWRIGHT_ARM_PLUGINS (separated by colons), in ~/.local/share/boltwright/arms ($XDG_DATA_HOME replaces
   ~/.local/share) and in /usr/lib/boltwright/arms. If two have the same NAME, the first is used. `boltwright
   devices` lists its arms as plugin:NAME:0, plugin:NAME:1, ...

     cc -std=c99 -shared -fPIC -I FOLDER_OF_THIS_HEADER my_arm.c -o ~/.local/share/boltwright/arms/my_arm.so

   UNITS AND FRAME
   m, rad, N, N.m, s. Right-handed: x to the user's right, y up, z towards the user; the origin is the middle
   of the reach.

   PROCESS AND THREADS
   Each open arm has a process of its own, which runs the plug-in and nothing else of Boltwright. One thread,
   the first of this process, calls all functions, one after another. So a plug-in needs no locks, except
   against its own threads. count() is also called in short-lived processes, even while another process has
   an arm open: it must not disturb that arm.

   If the arm's library has a thread of its own, exchange() stores the command (a force and a torque) for that
   thread and returns the newest state that the thread has measured.

   ORDER OF CALLS
   open, info, calibrate (until it is done), enable(1), exchange (many times), exchange with a zero command,
   enable(0), close. An arm may be closed at any point. count() need not come first. After a negative result
   Boltwright takes the text of last_error, closes the arm, and opens it again later.

   TIME
   exchange() is called at the arm's rate, 1000 times a second at most. It should return within 0.5 ms; after
   0.5 s without a return, the arm is given up. count() has 2 s, close() 1 s, other functions have 10 s. A
   process that needs longer is killed.

   SAFETY
   Boltwright clamps each command to the limits that info() reports, and these limits to 70 N, 3.1 N.m and
   8000 N/m. It ramps forces up, and stops them if the hand is too fast or jumps, or if the arm sends no
   sample for 8 ms. If Boltwright makes no call for 50 ms, the plug-in's process calls exchange() with a zero
   command. If this process ends or is killed, no function is called any more. THE ARM MUST THEN RELEASE ITS
   FORCE BY ITSELF: switch on its watchdog.

   A PLUG-IN MUST NOT
   - render any force other than the command of the latest exchange() and the compensation of the arm's own
     weight, nor any force at all before enable(1) or after enable(0);
   - let the arm move by itself, except in calibrate() with may_move;
   - end the process, throw a C++ exception, replace signal handlers, or close files that it has not opened;
   - read the standard input, which is empty. Its standard output goes to the standard error output.

   STRINGS
   UTF-8, terminated by NUL, one line. Boltwright copies them before it calls the next function, 255 bytes at
   most.

   VERSIONS
   Each structure begins with its size in bytes. Later versions of this header only append members.
   Boltwright sets the sizes of bw_arm_info_v1 and bw_arm_state_v1: write no member that lies beyond this
   size. It sets all other members to zero, except the orientation (1, 0, 0, 0) and the gripper (1) of a
   state. The size of bw_arm_v1 is set by the plug-in; Boltwright uses no member beyond it. A change that
   cannot be made by appending raises BW_ARM_ABI. */
#ifndef BOLTWRIGHT_ARM_H
#define BOLTWRIGHT_ARM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define BW_ARM_ABI 1u

/* Results. Negative: an error, which last_error explains. */
#define BW_ARM_ERROR (-1)
#define BW_ARM_DONE 0
#define BW_ARM_BUSY 1       /* calibrate: not done yet, call again */
#define BW_ARM_NEEDS_USER 2 /* calibrate: the user must act; last_error states how. Call again */
#define BW_ARM_MUST_MOVE 3  /* calibrate: the arm would have to move by itself, and may_move is 0 */
#define BW_ARM_NO_SAMPLE 4  /* exchange: the arm has sent nothing new since the last call */

/* Bits of bw_arm_info_v1.axes: a force along x, y, z, and a torque about x, y, z can be rendered. */
#define BW_ARM_FORCE_X 1u
#define BW_ARM_FORCE_Y 2u
#define BW_ARM_FORCE_Z 4u
#define BW_ARM_TORQUE_X 8u
#define BW_ARM_TORQUE_Y 16u
#define BW_ARM_TORQUE_Z 32u

/* Bits of bw_arm_info_v1.flags. */
#define BW_ARM_SENSES_ROTATION 1u /* without it, the tool keeps its orientation */
#define BW_ARM_SENSES_GRIPPER 2u  /* jaws for thumb and finger, which close and open the trainee's hand */

/* An open arm. The plug-in defines this structure as it likes. */
struct bw_arm;

/* Properties of an arm. A number that is not finite or is negative is an error. Larger values than those in
   brackets are reduced to them. */
struct bw_arm_info_v1 {
    uint32_t size;   /* bytes, set by Boltwright */
    uint32_t axes;   /* BW_ARM_FORCE_X | ... */
    uint32_t flags;  /* BW_ARM_SENSES_ROTATION | ... */
    int32_t buttons; /* 0 to 32 */
    /* Delay in ms, rounded up, from exchange() until the command acts and the state shows it. Allowed: 0 or
       1, at a rate of 1000 also 2. Boltwright adds the delay of its own threads. If the value is too small,
       forces may oscillate. */
    int32_t delay;
    uint32_t reserved;    /* 0 */
    char name[64];        /* of the arm, for the user; empty: the name of the plug-in */
    double rate;          /* new samples a second, 500 at least [1000] */
    double max_force;     /* N, magnitude that the arm renders for minutes [70]; 0 without axes of force */
    double max_torque;    /* N.m, magnitude [3.1]; 0 without axes of torque */
    double max_stiffness; /* N/m, that the arm renders stably [8000] */
    double max_torsion;   /* N.m/rad, likewise [40]; 0 without axes of torque */
    double max_damping;   /* N.s/m, that it renders without oscillation [20]; 0: none */
    double max_angular_damping; /* N.m.s/rad, likewise [0.1]; 0: none */
    double half_workspace[3];   /* m, half the workspace along each axis, above 0 [1] */
};

/* A force and a torque on the hand at the origin of the handle, along the axes of the frame above. */
struct bw_arm_command_v1 {
    uint32_t size; /* bytes, set by Boltwright */
    uint32_t reserved;
    double force[3];  /* N */
    double torque[3]; /* N.m */
};

/* Pose of the handle. A number that is not finite, a position beyond 2 m or a quaternion whose length is not
   1 (within 0.5 %) is an error: the arm counts as lost. */
struct bw_arm_state_v1 {
    uint32_t size;         /* bytes, set by Boltwright */
    uint32_t buttons;      /* bit i: button i is pressed */
    double position[3];    /* m */
    double orientation[4]; /* unit quaternion w, x, y, z; 1, 0, 0, 0: the handle's axes are those of the
                              frame above. Boltwright sets it to 1, 0, 0, 0 before each call */
    double gripper; /* 0 closed to 1 fully open; other values are clamped. With BW_ARM_SENSES_GRIPPER */
};

/* The functions of a plug-in; none may be null. The table must stay unchanged until the process ends. */
struct bw_arm_v1 {
    uint32_t size;     /* sizeof(struct bw_arm_v1) */
    uint32_t reserved; /* 0 */

    /* Returns how many arms are connected now (16 at most are listed), or BW_ARM_ERROR. */
    int (*count)(void);

    /* Opens arm `index`, from 0, without moving it and without force. `config` is the text of the file
       NAME.conf beside the plug-in, 4095 bytes at most, such as an arm's network address; empty if there is
       no such file. Returns NULL for an error, which last_error(NULL) explains. */
    struct bw_arm* (*open)(int index, const char* config);

    /* Describes the arm. Returns BW_ARM_DONE or BW_ARM_ERROR. */
    int (*info)(struct bw_arm* arm, struct bw_arm_info_v1* info);

    /* Lets the arm find its position. Called every 10 ms until it returns BW_ARM_DONE; return that at once if
       the position is known. Calls may pause for up to 1 s while the user must act, or while may_move is 0.
       It should not block. With `may_move` other than 0 the user has kept the room around the arm free, and
       the arm may move by itself for 90 s. While calibrate() returns BW_ARM_NEEDS_USER, the user reads the
       text of last_error. */
    int (*calibrate)(struct bw_arm* arm, int may_move);

    /* Switches the motors on (1), with zero force, or off (0). Returns BW_ARM_DONE or BW_ARM_ERROR. */
    int (*enable)(struct bw_arm* arm, int on);

    /* Renders `command` until the next call, and returns the newest state in `state`. May wait for the arm's
       next sample. Returns BW_ARM_DONE, BW_ARM_NO_SAMPLE, or BW_ARM_ERROR: the arm is lost, for example
       unplugged. */
    int (*exchange)(struct bw_arm* arm, const struct bw_arm_command_v1* command,
                    struct bw_arm_state_v1* state);

    /* Returns the message of the last call of a function with this arm: the fault and its remedy. With NULL
       as `arm`: of the last count or open. Never fails; a result of NULL is an empty text. */
    const char* (*last_error)(struct bw_arm* arm);

    /* Releases the force and the arm. */
    void (*close)(struct bw_arm* arm);
};

#define BW_ARM_EXPORT __attribute__((visibility("default")))

/* Returns the plug-in's functions; NULL if the plug-in does not support version `abi`. */
BW_ARM_EXPORT const struct bw_arm_v1* bw_arm_entry(uint32_t abi);

#ifdef __cplusplus
}
#endif

#endif
