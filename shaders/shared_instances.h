// What GLSL and C++ share of instances (prt/instances.h). Included by both: plain preprocessor only.
#ifndef PRT_SHARED_INSTANCES_H
#define PRT_SHARED_INSTANCES_H

#define PRT_BINDING_INSTANCES 7 // storage buffer of prt::instance_table

// Rows of an instance in its table: passing modes, added modes with the turn in w of the first, the middle of the
// box, one over its half widths.
#define PRT_INSTANCE_PASSING 5u
#define PRT_INSTANCE_MODES 9u
#define PRT_INSTANCE_TABLE_ROWS 11u

#endif
