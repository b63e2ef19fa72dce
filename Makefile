# Talus. `make help` lists what there is to make; README.md says what for.
ifeq ($(origin CC),default)
CC = gcc
endif
CXX ?= g++
AR ?= ar
BUILD ?= build
OPT ?= -O3
PREFIX ?= /usr/local
# EXE: what programs end in; RUN: what runs them, such as qemu-aarch64 for a cross build.
EXE ?=
RUN ?=
CFLAGS ?=
LDFLAGS ?=
WERROR ?= -Werror
FUZZ_TIME ?= 60
TESTS ?=

WARN = -pedantic -Wall -Wextra -Wconversion -Wshadow -Wmissing-prototypes $(WERROR)
# -ffp-contract=off: a fused multiply-add has other bits than the two operations.
# -fno-strict-aliasing: the lanes load and store floats as integers and back; gcc 12 at -O3 on AArch64 reorders such a
# load before the store of the same bytes.
# -fno-builtin-bcmp: clang makes bcmp of some memcmp, one more function to ask the world for.
MATH = -ffp-contract=off -fno-strict-aliasing -fno-builtin-bcmp
TARGET := $(shell $(CC) $(CFLAGS) -dumpmachine 2>/dev/null)
# clang before 16 vectorises plain code for wasm wrongly: loads drift past stores. To it a later -O2 takes these two back,
# so MATH stands last.
ifneq ($(filter wasm%,$(TARGET)),)
MATH += -msimd128
ifneq ($(filter clang-1 clang-2 clang-3 clang-4 clang-5 clang-6 clang-7 clang-8 clang-9 clang-10 clang-11 clang-12 clang-13 \
    clang-14 clang-15,clang-$(firstword $(subst ., ,$(shell $(CC) -dumpversion)))),)
MATH += -fno-vectorize -fno-slp-vectorize
endif
endif
# gcc's straight-line vectoriser makes fused multiply-add-subtracts whatever -ffp-contract says (seen in gcc 12), where
# the processor asked for, as by -march=native, has them.
FUSED := $(shell $(CC) $(CFLAGS) $(OPT) -dM -E -x c /dev/null 2>/dev/null | \
    grep -E '__(FMA|FMA4|AVX512F)__|__ARM_FEATURE_COMPLEX|__clang__' | tr '\n' ' ')
ifneq ($(FUSED),)
ifeq ($(findstring __clang__,$(FUSED)),)
MATH += -fno-tree-slp-vectorize
endif
endif
# s390 takes C99 to mean that floats are worked out as doubles.
ifneq ($(filter s390%,$(TARGET)),)
MATH += -fexcess-precision=fast
endif
AVX2 = $(if $(filter x86_64% amd64%,$(TARGET)),-mavx2)

C_FLAGS = -std=c99 $(WARN) $(OPT) $(CFLAGS) $(MATH)
INCLUDES = -Iinclude -Isrc -Iplatform -Itools
DEPENDS = -MMD -MP
Q = @

LIB = $(BUILD)/libtalus.a
TOOL = $(BUILD)/talus$(EXE)
SRC := $(sort $(wildcard src/*/*.c src/stage/*/*.c))
OBJ := $(SRC:%.c=$(BUILD)/%.o)

# The tool: its main beside what the tests link of it too.
TOOL_MAIN := $(wildcard tools/talus/main.c)
TOOLS_SRC := $(sort $(filter-out %/main.c,$(wildcard tools/gltf/*.c tools/talus/*.c platform/host/*.c)))
TOOLS_LIB = $(BUILD)/libtools.a
TOOLS_OBJ := $(TOOLS_SRC:%.c=$(BUILD)/%.o) $(BUILD)/tools/talus/profile_page.o

# tests/*/NAME_test.c is a program each; what else lies there, but for fuzzers and *_main.c, is linked to all of them.
TEST_SRC := $(sort $(wildcard tests/*/*_test.c))
# The long ones first, so that no processor waits for the last.
LONG_TESTS = tests/unit/random_worlds_test.c tests/unit/record_test.c tests/unit/quickhull_test.c
TEST_BIN := $(patsubst %.c,$(BUILD)/%$(EXE),$(LONG_TESTS) $(filter-out $(LONG_TESTS),$(TEST_SRC)))
HELP_SRC := $(sort $(filter-out %_test.c %_fuzz.c %_main.c tests/golden/%,$(wildcard tests/*/*.c)))
HELP_CXX := $(sort $(wildcard tests/*/*.cpp))
HELP_LIB = $(BUILD)/libtesthelp.a
HELP_OBJ := $(HELP_SRC:%.c=$(BUILD)/%.o) $(HELP_CXX:%.cpp=$(BUILD)/%.o)
GOLDEN_SRC := $(sort $(wildcard tests/golden/*.c))
GOLDEN = $(BUILD)/golden$(EXE)
FUZZ_SRC := $(sort $(wildcard tests/fuzz/*_fuzz.c))
FUZZ_NAMES := $(FUZZ_SRC:tests/fuzz/%.c=%)
# Only what a test uses of them ends up in it.
TEST_LIBS = -Wl,--as-needed -lcmocka -lccd -lcjson -lm
TEST_LINK = $(CC)

HAS_CJSON := $(shell printf '\#include <cjson/cJSON.h>\n' | $(CC) $(CFLAGS) -E - >/dev/null 2>&1 && echo yes)

# libccd is nothing that the tool needs: `talus bench queries` times it beside the library's own where it is there.
HAS_CCD := $(shell printf '\#include <ccd/ccd.h>\n' | $(CC) $(CFLAGS) -E - >/dev/null 2>&1 && echo yes)
TOOL_LIBS = -lcjson $(if $(HAS_CCD),-lccd) -lm
$(BUILD)/tools/talus/bench_ccd.o: DEFINES = $(if $(HAS_CCD),-DTALUS_TOOL_CCD)

.PHONY: all lib tool run test bench feature-cost snapshot-cost sanitize fuzz golden golden-update lint format install deps deps-full ci clean help FORCE
.DELETE_ON_ERROR:

all: lib $(if $(HAS_CJSON),tool,no-tool)
lib: $(LIB)
tool: $(if $(TOOL_MAIN),$(TOOL))
.PHONY: no-tool
no-tool: lib
	@echo "  cJSON is missing: the tool was left out; 'make deps' installs what it needs"

help:
	@echo "make                the library $(LIB) and the tool $(TOOL)"
	@echo "make run            installs what is missing, builds, and runs a scene into $(BUILD)/showcase.glb"
	@echo "make test           installs what is missing; all tests and the golden hashes (TESTS='block loop': some)"
	@echo "make sanitize       the tests under AddressSanitizer and UndefinedBehaviorSanitizer"
	@echo "make golden         the golden hashes over compilers, levels, instruction sets, processors (FAST=1: this one)"
	@echo "make golden-update  takes this build's hashes as the golden ones"
	@echo "make fuzz           every fuzzer for FUZZ_TIME=$(FUZZ_TIME) seconds, by chance or by FUZZ_SEED=N"
	@echo "make bench          own scenes and where their time goes"
	@echo "make feature-cost   what features cost scenes that have none of them, in instructions"
	@echo "make snapshot-cost  what a snapshot takes, in bytes and beside a memcpy"
	@echo "make lint           symbols, includes, headers, format"
	@echo "make format         clang-format over the tree"
	@echo "make install        headers, library, tool, package files to PREFIX=$(PREFIX) (DESTDIR is put before it)"
	@echo "make deps           installs what the tool and the tests need; deps-full: what all targets need"
	@echo "make ci             what .ci/run does"
	@echo "make clean          removes $(BUILD)"
	@echo "CC, OPT, CFLAGS, LDFLAGS, BUILD, RUN can be set"

# --- compiling --------------------------------------------------------------------------------------

# Objects are made anew when the compiler or its flags change.
$(BUILD)/flags: FORCE
	@mkdir -p $(@D)
	@echo '$(CC) $(C_FLAGS) $(AVX2) $(LDFLAGS)' | cmp -s - $@ || echo '$(CC) $(C_FLAGS) $(AVX2) $(LDFLAGS)' > $@

$(BUILD)/%_avx2.o: %_avx2.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "  CC $<"
	$(Q)$(CC) $(C_FLAGS) $(AVX2) $(INCLUDES) $(DEPENDS) -c $< -o $@

$(BUILD)/%.o: %.c $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "  CC $<"
	$(Q)$(CC) $(C_FLAGS) $(DEFINES) $(INCLUDES) $(DEPENDS) -c $< -o $@

# The page as bytes: a string of its length is more than C99 promises to take.
$(BUILD)/tools/talus/profile_page.c: tools/talus/profile_page.html
	@mkdir -p $(@D)
	@{ echo '#include "talus/profile_page.h"'; echo 'const unsigned char profile_page[] = {'; \
	    od -An -v -tx1 $< | sed 's/ *\([0-9a-f][0-9a-f]\)/0x\1,/g'; echo '0};'; } > $@

$(BUILD)/%.o: $(BUILD)/%.c $(BUILD)/flags
	@echo "  CC $<"
	$(Q)$(CC) $(C_FLAGS) $(INCLUDES) $(DEPENDS) -c $< -o $@

$(BUILD)/%.o: %.cpp $(BUILD)/flags
	@mkdir -p $(@D)
	@echo "  CXX $<"
	$(Q)$(CXX) -std=c++11 -Wall -Wextra $(WERROR) $(OPT) $(CFLAGS) $(MATH) $(INCLUDES) $(DEPENDS) -c $< -o $@

define archive
@rm -f $@
@echo "  AR $@"
$(Q)$(AR) rcs $@ $(filter %.o,$^)
endef

$(LIB): $(OBJ)
	$(archive)

$(TOOLS_OBJ) $(TOOL_MAIN:%.c=$(BUILD)/%.o): | need-deps
$(TOOLS_LIB): $(TOOLS_OBJ)
	$(archive)

$(TOOL): $(TOOL_MAIN:%.c=$(BUILD)/%.o) $(TOOLS_LIB) $(LIB)
	@echo "  LD $@"
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $^ $(TOOL_LIBS) -o $@

# --- tests ------------------------------------------------------------------------------------------

$(HELP_OBJ) $(TEST_SRC:%.c=$(BUILD)/%.o): | need-deps
# Tests may use what the host's C library has beyond C99: aligned_alloc.
$(TEST_SRC:%.c=$(BUILD)/%.o): INCLUDES += -D_ISOC11_SOURCE
$(HELP_LIB): $(HELP_OBJ)
	$(archive)

$(BUILD)/tests/unit/alloc_test$(EXE): WRAP = -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free

$(BUILD)/tests/oracle/box2d_test$(EXE): TEST_LINK = $(CXX)
$(BUILD)/tests/oracle/box2d_test$(EXE): TEST_LIBS += -lbox2d

$(TEST_BIN): $(BUILD)/%$(EXE): $(BUILD)/%.o $(HELP_LIB) $(TOOLS_LIB) $(LIB)
	@echo "  LD $@"
	$(Q)$(TEST_LINK) $(CFLAGS) $(LDFLAGS) $(WRAP) $^ $(TEST_LIBS) -o $@

# Of objects, without the archive: llvm's linker takes only llvm's archives, link-time optimisation only its compiler's.
$(GOLDEN): $(GOLDEN_SRC:%.c=$(BUILD)/%.o) $(OBJ)
	@echo "  LD $@"
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lm -o $@

test: $(if $(TESTS),$(foreach t,$(TESTS),$(filter %/$(t)_test$(EXE),$(TEST_BIN))),$(TEST_BIN)) $(GOLDEN) lib tool
	@RUN="$(RUN)" BUILD="$(BUILD)" sh tools/ci/run-tests.sh $(GOLDEN) $(filter $(BUILD)/tests/%,$^)

# Tests and fuzzers under the sanitizers are of one build.
SAN_CC ?= clang
SAN_CXX ?= clang++
SAN_BUILD = $(BUILD)/san
SAN_MAKE = $(MAKE) --no-print-directory CC=$(SAN_CC) CXX=$(SAN_CXX) BUILD=$(SAN_BUILD) OPT="-O2 -g" WERROR= \
    CFLAGS="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all $(CFLAGS)"
.PHONY: need-san
need-san:
	@command -v $(SAN_CC) >/dev/null || sh tools/ci/install-deps.sh full
sanitize: need-san
	@+$(SAN_MAKE) test

golden:
	@$(if $(FAST),,sh tools/ci/install-deps.sh matrix)
	@BUILD="$(BUILD)" FAST="$(FAST)" sh tools/ci/golden.sh

golden-update: $(GOLDEN)
	$(RUN) $(GOLDEN) > $(BUILD)/hashes.txt
	@mv $(BUILD)/hashes.txt tests/golden/hashes.txt

fuzz: need-san
	@+$(SAN_MAKE) fuzz-programs
	@printf '%s\n' $(FUZZ_NAMES:%=$(SAN_BUILD)/%) | FUZZ_TIME=$(FUZZ_TIME) xargs -P "$$(nproc)" -n 1 sh tools/ci/run-fuzzer.sh

.PHONY: fuzz-programs
fuzz-programs: $(FUZZ_NAMES:%=$(BUILD)/%)
$(FUZZ_NAMES:%=$(BUILD)/%): $(BUILD)/%: $(BUILD)/tests/fuzz/%.o $(TOOLS_LIB) $(LIB)
	@echo "  LD $@"
	$(Q)$(CC) $(CFLAGS) -fsanitize=fuzzer $^ -lcjson -lm -o $@

# --- the rest ---------------------------------------------------------------------------------------

run: tool
	$(TOOL) run @showcase --animate $(BUILD)/showcase.glb

bench: tool
	@sh tools/ci/bench.sh $(TOOL)

COST = $(BUILD)/tools/bench/snapshot_cost$(EXE)
$(COST): %$(EXE): %.o $(TOOLS_LIB) $(LIB)
	@echo "  LD $@"
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) $^ -lm -o $@
snapshot-cost: $(COST)
	$(RUN) $<
feature-cost:
	@sh tools/ci/install-deps.sh full
	@CC="$(CC)" BUILD="$(BUILD)" sh tools/ci/check-feature-cost.sh

lint: lib
	@sh tools/ci/check-symbols.sh $(LIB)
	@sh tools/ci/check-includes.sh
	@CC="$(CC)" CXX="$(CXX)" sh tools/ci/check-headers.sh
	@sh tools/ci/check-format.sh

format:
	@clang-format -i $$(sh tools/ci/sources.sh)

.PHONY: need-deps
need-deps deps:
	@CC="$(CC)" sh tools/ci/install-deps.sh base
deps-full:
	@CC="$(CC)" sh tools/ci/install-deps.sh full

install: all
	install -d "$(DESTDIR)$(PREFIX)/include/talus" "$(DESTDIR)$(PREFIX)/lib/pkgconfig" "$(DESTDIR)$(PREFIX)/lib/cmake/talus"
	install -m 644 include/talus/*.h "$(DESTDIR)$(PREFIX)/include/talus"
	install -m 644 $(LIB) "$(DESTDIR)$(PREFIX)/lib"
	@sh tools/ci/package-files.sh "$(PREFIX)" "$(DESTDIR)$(PREFIX)/lib"
	@if [ -x $(TOOL) ]; then install -d "$(DESTDIR)$(PREFIX)/bin"; install -m 755 $(TOOL) "$(DESTDIR)$(PREFIX)/bin"; fi

ci:
	@bash .ci/run

clean:
	rm -rf $(BUILD)

-include $(OBJ:.o=.d) $(TOOLS_OBJ:.o=.d) $(HELP_OBJ:.o=.d) $(TEST_SRC:%.c=$(BUILD)/%.d) $(GOLDEN_SRC:%.c=$(BUILD)/%.d) \
    $(FUZZ_SRC:%.c=$(BUILD)/%.d) $(TOOL_MAIN:%.c=$(BUILD)/%.d)
