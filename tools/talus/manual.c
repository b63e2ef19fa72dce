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
    "    talus scene NAME [-o FILE.gltf]\n"
    "    talus scene --list\n"
    "    talus record SCENE -o FILE.trec [OPTION]...\n"
    "    talus replay FILE.trec [OPTION]...\n"
    "    talus diff A.trec B.trec [OPTION]...\n"
    "    talus help [SUBCOMMAND]\n"
    "    talus version\n"
    "\n"
    "DESCRIPTION\n"
    "    run      runs a scene and says how long steps took, what memory they used and which bits came out\n"
    "    scene    writes one of the tool's own scenes as glTF\n"
    "    record   runs a scene and writes what was done to its world\n"
    "    replay   does it again, by any instruction set, and compares every step\n"
    "    diff     finds the first step, stage, column, body and value in which two recordings part\n"
    "    help     this text, or that of a subcommand\n"
    "    version  the version of the tool and the library\n"
    "\n",
    "EXIT STATUS\n"
    "    0  done\n"
    "    1  it could not be done: a file could not be read or written, or memory ran out\n"
    "    2  the command line is wrong\n"
    "    3  the scene, or an option, asks for what is not supported\n"
    "    4  the file is broken\n"
    "    5  two runs part (replay, diff)\n"
    "    6  two runs are the same as far as the shorter one goes (replay, diff)\n"
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

static const char *const record_page[] = {
    "NAME\n"
    "    talus record - runs a scene and writes what was done to its world\n"
    "\n"
    "SYNOPSIS\n"
    "    talus record SCENE -o FILE.trec [--steps N] [--dt S] [--substeps N] [--iterations N] [--isa SET]\n"
    "                 [--no-sleep] [--flip STEP:COLUMN:ROW:BIT] [--quiet]\n"
    "\n"
    "DESCRIPTION\n"
    "    Steps SCENE as `talus run` does and writes a recording: the hulls, the state before the first step and\n"
    "    every so often after it (a keyframe), all commands, and after every step a hash of each column of the\n"
    "    state: of what is awake, and every 64 steps of all of it. A recording that is cut off replays up to the\n"
    "    cut. The library writes the same from within an engine (talus/record.h).\n"
    "\n"
    "OPTIONS\n"
    "    -o, --output FILE.trec  the file to write\n"
    "    --flip STEP:COLUMN:ROW:BIT\n"
    "                       after step STEP flip one bit of the state, which shows that `talus diff` finds it.\n"
    "                       COLUMN is a name (a wrong one gets the list of them), BIT counts from the row's first\n"
    "                       word on, lowest bit first. A flip with which the state is no longer sound is refused\n"
    "    --quiet            print nothing but what went wrong\n"
    "    --help             this text\n"
    "    The others are those of `talus run`.\n"
    "\n",
    "EXIT STATUS\n"
    "    0 done, 1 it failed, 2 the command line is wrong, 3 unsupported, 4 the scene's file is broken\n"
    "\n"
    "EXAMPLES\n"
    "    talus record @pile -o pile.trec\n"
    "    talus record @pile -o flipped.trec --flip 120:body_velocity:17:5\n"
    "    talus diff pile.trec flipped.trec\n",
    NULL};

static const char *const replay_page[] = {
    "NAME\n"
    "    talus replay - does again what a recording holds and compares every step\n"
    "\n"
    "SYNOPSIS\n"
    "    talus replay FILE.trec [--isa SET] [--to STEP] [--sync-test] [--json] [--summary FILE.md]\n"
    "                 [--junit FILE.xml] [--quiet]\n"
    "\n"
    "DESCRIPTION\n"
    "    Does the recording's commands to its first state and compares the hash of every column after every\n"
    "    step. Where they part it names the step, the stage and the column: the first in the order of a step.\n"
    "\n"
    "OPTIONS\n"
    "    --isa SET          scalar, sse2, avx2, neon, wasm or best (default: best)\n"
    "    --to STEP          stop after this step\n"
    "    --sync-test        at each step save the world, step, restore, step again, and compare: what a game\n"
    "                       with rollback relies on\n"
    "    --json             print one line of JSON\n"
    "    --summary FILE.md  add a table in Markdown to the file, as $GITHUB_STEP_SUMMARY is filled\n"
    "    --junit FILE.xml   write a JUnit report of one test case\n"
    "    --quiet            print nothing but what went wrong\n"
    "    --help             this text\n"
    "\n"
    "EXIT STATUS\n"
    "    0  every step is the same\n"
    "    1  the file could not be read, or memory ran out\n"
    "    2  the command line is wrong\n"
    "    3  the recording is of another version, or the instruction set is not to be had\n"
    "    4  the recording is damaged; the message has the offset\n"
    "    5  a step is not the same\n"
    "    6  every step is the same, but the end of the recording is missing\n"
    "\n"
    "EXAMPLES\n"
    "    talus replay pile.trec --isa scalar --junit replay.xml\n",
    NULL};

static const char *const diff_page[] = {
    "NAME\n"
    "    talus diff - finds where two recordings part\n"
    "\n"
    "SYNOPSIS\n"
    "    talus diff A.trec B.trec [--json] [--summary FILE.md] [--junit FILE.xml] [--quiet]\n"
    "\n"
    "DESCRIPTION\n"
    "    Finds the first step after which the recorded hashes differ, replays both from the last keyframe before\n"
    "    it, and names the step, the stage that wrote the column, the column, its row, the bodies that the row\n"
    "    is of, the word in it and both values, as bits and as a float:\n"
    "\n"
    "      step 120: stage commit, body_velocity of body 17, word 0: 0x3f8147ae (1.01) and 0x3f81478e (1.00999)\n"
    "\n"
    "    If the commands of the step differ too, it says so. If a recording does not replay here to its own\n"
    "    hashes, as one from a machine that errs, it says which and from where on, and names step, stage and\n"
    "    column by the hashes alone; of what sleeps these know every 64th step.\n"
    "\n"
    "OPTIONS\n"
    "    --json, --summary FILE.md, --junit FILE.xml, --quiet, --help: as for `talus replay`\n"
    "\n",
    "EXIT STATUS\n"
    "    0  they are the same\n"
    "    1  a file could not be read, or memory ran out\n"
    "    2  the command line is wrong\n"
    "    3  they cannot be compared: another version, other capacities\n"
    "    4  a recording is damaged; the message has the offset\n"
    "    5  they part\n"
    "    6  they are the same as far as the shorter one goes\n"
    "\n"
    "EXAMPLES\n"
    "    talus diff server.trec console.trec --summary \"$GITHUB_STEP_SUMMARY\"\n",
    NULL};

int tool_print_manual(const char *subcommand) {
    static const struct {
        const char *name;
        const char *const *page;
    } pages[] = {{"run", run_page},
                 {"scene", scene_page},
                 {"record", record_page},
                 {"replay", replay_page},
                 {"diff", diff_page}};
    const char *const *page = subcommand == NULL ? talus_page : NULL;
    for (size_t i = 0; subcommand != NULL && i < sizeof pages / sizeof *pages; i++) {
        if (strcmp(subcommand, pages[i].name) == 0) {
            page = pages[i].page;
        }
    }
    for (int i = 0; page != NULL && page[i] != NULL; i++) {
        fputs(page[i], stdout);
    }
    return page != NULL;
}
