# Talus. `make help` lists the targets.
CC ?= gcc
BUILD ?= build
OPT ?= -O3
WARN = -std=c99 -pedantic -Wall -Wextra -Wconversion -Wshadow -Wmissing-prototypes -Werror
CFLAGS ?=
ALL_CFLAGS = $(WARN) -ffp-contract=off $(OPT) $(CFLAGS) -Iinclude -Isrc -Iplatform -MMD -MP

SRC := $(sort $(wildcard src/*/*.c src/stage/*/*.c))
OBJ := $(SRC:%.c=$(BUILD)/%.o)

all: $(BUILD)/libtalus.a

$(BUILD)/libtalus.a: $(OBJ)
	@rm -f $@
	ar rcs $@ $(OBJ)

$(BUILD)/%_avx2.o: %_avx2.c
	@mkdir -p $(@D)
	@echo "  CC $<"; $(CC) $(ALL_CFLAGS) -mavx2 -c $< -o $@

$(BUILD)/%.o: %.c
	@mkdir -p $(@D)
	@echo "  CC $<"; $(CC) $(ALL_CFLAGS) -c $< -o $@

clean:
	rm -rf $(BUILD)

-include $(OBJ:.o=.d)
.PHONY: all clean
