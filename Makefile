# The two commands of the README, and what they are made of.
#
#   make demo    sets up, builds, and runs the main job; ARGS="..." are handed on
#   make test    sets up, builds and runs every test
#   make build   sets up and builds the program: build/release/hapticgiant

ARGS ?=
PRESET ?= release
BUILD := build/$(PRESET)

.PHONY: demo build test format check clean

demo: build
	@$(BUILD)/hapticgiant run $(ARGS)

build:
	@tools/setup.sh build
	@tools/configure.sh $(PRESET)
	@cmake --build $(BUILD) --target hapticgiant

test:
	@tools/setup.sh test
	@tools/configure.sh $(PRESET)
	@cmake --build $(BUILD)
	@PATH="$(CURDIR)/.venv/bin:$$PATH" ctest --test-dir $(BUILD) --output-on-failure --no-tests=error

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

check:
	@git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
	@.venv/bin/python tools/check_modules.py

clean:
	rm -rf build viewer/dist
