/* Talus: rigid-body physics in one block of memory. This header has all the others. */
#ifndef TALUS_H
#define TALUS_H

#include "talus/body.h"
#include "talus/command.h"
#include "talus/events.h"
#include "talus/hull.h"
#include "talus/joint.h"
#include "talus/lcp.h"
#include "talus/loop.h"
#include "talus/profile.h"
#include "talus/query.h"
#include "talus/record.h"
#include "talus/rollback.h"
#include "talus/shape.h"
#include "talus/snapshot.h"
#include "talus/types.h"
#include "talus/version.h"
#include "talus/world.h"
#include "talus/world_query.h"

#endif
