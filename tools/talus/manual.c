/* The manual pages: what `talus help` prints. */
#include "tool.h"

#include <stdio.h>
#include <string.h>

static const char *const talus_page[] = {
    "NAME\n"
    "    talus - runs rigid-body physics scenes without a window\n"
    "\n"
    "SYNOPSIS\n"
    "    talus run SCENE [OPTION]...\n"
    "    talus profile SCENE [OPTION]...\n"
    "    talus scene NAME [-o FILE.gltf]\n"
    "    talus scene --list\n"
    "    talus help [SUBCOMMAND]\n"
    "    talus version\n"
    "\n"
    "DESCRIPTION\n"
    "    run      runs a scene and says how long steps took, what memory they used and which bits came out\n"
    "    profile  says which steps of a scene take long and why\n"
    "    scene    writes one of the tool's own scenes as glTF\n"
    "    help     this text, or that of a subcommand\n"
    "    version  the version of the tool and the library\n"
    "\n",
    "EXIT STATUS\n"
    "    0  done\n"
    "    1  it could not be done: a file could not be read or written, or memory ran out\n"
    "    2  the command line is wrong\n"
    "    3  the scene, or an option, asks for what is not supported\n"
    "    4  the scene's file is broken\n"
    "    5  it was done and took longer than asked for (talus profile)\n"
    "\n"
    "EXAMPLES\n"
    "    talus run @showcase --animate showcase.glb\n"
    "    talus help run\n",
    NULL};

static const char *const run_page[] = {
    "NAME\n"
    "    talus run - runs a scene\n"
    "\n"
    "SYNOPSIS\n"
    "    talus run SCENE [--out FILE.ptrj] [--animate FILE.glb] [--steps N] [--dt S] [--substeps N]\n"
    "              [--iterations N] [--isa SET] [--no-sleep] [--json [--profile]] [--quiet]\n"
    "\n"
    "DESCRIPTION\n"
    "    Loads SCENE, steps it, and prints a report. SCENE is a .gltf or .glb file (glTF 2.0 with\n"
    "    KHR_implicit_shapes and KHR_physics_rigid_bodies, draft of October 2025), or @NAME for one of the\n"
    "    tool's own scenes (talus scene --list). SI units throughout.\n"
    "\n"
    "    Bodies are the nodes with `motion`, in the order of the nodes; colliders below none of them are static.\n"
    "    scenes[].extras may hold gravity [x,y,z] (m/s^2, default 0 -9.81 0), dt (s, default 1/60), steps (default\n"
    "    600) and note. Without a mass, a body has 1000 kg/m^3 times its colliders' volume; without a material,\n"
    "    a collider has friction 0.5.\n"
    "\n"
    "    Triangle meshes are not supported: \"convexHull\": true makes hulls of them.\n"
    "\n"
    "    The same scene and options give the same bits on every machine and with every instruction set.\n"
    "\n",
    "OPTIONS\n"
    "    --out FILE.ptrj    write the trajectory: the state of every body after every step\n"
    "    --animate FILE.glb write an animation (30 frames a second) that any glTF viewer shows\n"
    "    --steps N          run N steps (default: the scene's)\n"
    "    --dt S             of S seconds each, from 1e-6 to 1 (default: the scene's)\n"
    "    --substeps N       solve each step in N sub-steps, 1 to 64 (default: the library's)\n"
    "    --iterations N     with N passes of the solver in each, 1 to 64 (default: the library's)\n"
    "    --isa SET          scalar, sse2, avx2, neon, wasm or best (default: best)\n"
    "    --no-sleep         bodies at rest are not put to sleep\n"
    "    --threads 1        accepted for runners that set it; a step runs on one thread\n"
    "    --json             print one line of JSON instead of the report\n"
    "    --profile          with --json: time the stages of the step as well (the clock costs a little)\n"
    "    --quiet            print nothing, except --json and what went wrong\n"
    "    --help             this text\n"
    "\n"
    "REPORT\n"
    "    The scene's size; the time of talus_world_step alone (monotonic clock); the share of each stage; the\n"
    "    memory of the world's block and how full its capacities got; what was skipped because nothing asked for\n"
    "    it; a hash of the world's state, and one of the last frame of the trajectory.\n"
    "\n",
    "EXIT STATUS\n"
    "    0  done\n"
    "    1  the run failed: a file could not be read or written, or memory ran out\n"
    "    2  the command line is wrong\n"
    "    3  the scene, or an option, asks for what is not supported\n"
    "    4  the scene's file is broken; the message names the place in it, as in\n"
    "       talus: tower.gltf: $.nodes[3].rotation: has length 2, must be a unit quaternion x y z w\n"
    "\n"
    "EXAMPLES\n"
    "    talus run @pyramid\n"
    "    talus run tower.gltf --steps 1200 --substeps 8 --out tower.ptrj --json\n"
    "    talus run @showcase --animate showcase.glb --quiet\n"
    "\n"
    "SEE ALSO\n"
    "    talus help scene\n",
    NULL};

static const char *const profile_manual[] = {
    "NAME\n"
    "    talus profile - says which steps of a scene take long, and why\n"
    "\n"
    "SYNOPSIS\n"
    "    talus profile SCENE [--steps N] [--runs N] [--substeps N] [--isa SET] [--no-sleep] [--budget MS]\n"
    "                  [--json] [--csv FILE] [--trace FILE] [--html FILE]\n"
    "\n"
    "DESCRIPTION\n"
    "    Runs SCENE (as in talus help run) several times from its beginning. The runs are the same to the bit,\n"
    "    which is checked, so what differs in time is the machine: of each step, and of each stage of it, the least\n"
    "    time over the runs is taken. The stages of a step may thus add up to less than the step.\n"
    "\n"
    "    On a terminal the bars of the stages are drawn while it runs. Then: the stages with mean, p50, p95, p99,\n"
    "    p99.9 and max, and the worst steps, each with what it held that the median step did not.\n"
    "\n"
    "    Times of an island are a share: islands are solved side by side in lanes. See include/talus/profile.h.\n"
    "\n"
    "OPTIONS\n"
    "    --steps N       run N steps, to 1000000 (default: the scene's)\n"
    "    --runs N        times, 1 to 1000 (default: 5)\n"
    "    --substeps N    solve each step in N sub-steps, 1 to 64 (default: the library's)\n"
    "    --isa SET       scalar, sse2, avx2, neon, wasm or best (default: best)\n"
    "    --no-sleep      bodies at rest are not put to sleep\n"
    "    --budget MS     fail where a step takes longer, and tell which did and what they held\n"
    "    --json          print one line of JSON instead of the tables: all figures, frames and runs\n"
    "    --csv FILE      a row a step: times (ns) and counts\n"
    "    --trace FILE    trace events for Perfetto or chrome://tracing; steps stand one after the other\n"
    "    --html FILE     one page with charts that needs nothing else: open it in a browser\n"
    "    --help          this text\n"
    "    A FILE of - is the standard output.\n"
    "\n"
    "EXIT STATUS\n"
    "    0  done\n"
    "    1  it failed: a file could not be read or written, memory ran out, or the runs differed\n"
    "    2  the command line is wrong\n"
    "    3  the scene, or an option, asks for what is not supported\n"
    "    4  the scene's file is broken\n"
    "    5  a step went over the budget\n"
    "\n"
    "EXAMPLES\n"
    "    talus profile @pile --budget 2 --html pile.html\n"
    "\n"
    "SEE ALSO\n"
    "    talus help run\n",
    NULL};

static const char *const scene_page[] = {
    "NAME\n"
    "    talus scene - writes one of the tool's own scenes as glTF\n"
    "\n"
    "SYNOPSIS\n"
    "    talus scene NAME [-o FILE.gltf]\n"
    "    talus scene --list\n"
    "\n"
    "DESCRIPTION\n"
    "    Writes scene NAME to a file that `talus run` and other programs read. The text is the same on every\n"
    "    machine. `talus run @NAME` runs the scene without a file.\n"
    "\n"
    "OPTIONS\n"
    "    -o, --output FILE  write to FILE (default: -, the standard output)\n"
    "    -l, --list         list the scenes\n"
    "    --help             this text\n"
    "\n"
    "EXIT STATUS\n"
    "    0 done, 1 the file could not be written, 2 the command line is wrong or there is no such scene\n"
    "\n"
    "EXAMPLES\n"
    "    talus scene ragdolls -o ragdolls.gltf\n",
    NULL};

int tool_print_manual(const char *subcommand) {
    const char *const *page = subcommand == NULL                   ? talus_page
                              : strcmp(subcommand, "run") == 0     ? run_page
                              : strcmp(subcommand, "profile") == 0 ? profile_manual
                              : strcmp(subcommand, "scene") == 0   ? scene_page
                                                                   : NULL;
    for (int i = 0; page != NULL && page[i] != NULL; i++) {
        fputs(page[i], stdout);
    }
    return page != NULL;
}
