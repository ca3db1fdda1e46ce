#ifndef PRT_VERSION_H
#define PRT_VERSION_H

/* The version MAJOR.MINOR.PATCH of prtkit's headers, for C and C++. Stable. */
#define PRTKIT_VERSION_MAJOR 0
#define PRTKIT_VERSION_MINOR 1
#define PRTKIT_VERSION_PATCH 0

#endif
