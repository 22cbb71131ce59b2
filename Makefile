# The two commands of the README, and what they are made of.
#
#   make demo    sets up, builds, and runs the main job; ARGS="..." are handed on
#   make test    sets up, builds and runs every test
#   make build   sets up and builds all programs: build/release/hapticgiant and those behind its
#                offline commands (experiment, export, identify, design, bridge ros2, ...)
#   make wheel   builds all programs and packs them for pip, into build/wheel: one file for every Python
#                from 3.10 on
#   make deb     the same for apt, into build/deb
#   make test-wheel
#                packs the wheel twice, installs it into fresh environments of every Python that is at hand
#                and uses it there
#   make test-packages
#                that, the same with the Debian package, and with the wheel, in a bare Debian (as root,
#                with mmdebstrap), and pip install from a clean copy; minutes
#   make bench   measures solver, cycle and laws beside the paper's solver into build/bench, and refreshes
#                docs/reports/benchmarks.md; minutes
#   make experiments
#                runs the paper's experiments with both laws and its Table III (haptify) into
#                build/experiments and refreshes the pages of docs/experiments and
#                docs/reports/fault_campaign.md; minutes
#   make arms    measures the arms of models/arms (Haptify, cupboard, drawer, tool) into build/arms and
#                refreshes docs/reports/arms.md; minutes
#   make bench-instructions
#                counts their instructions (callgrind), into a table of the same page
#   make sanitize
#                builds and runs the tests that pay off under sanitizers: address and undefined
#                behaviour for the control cycle and what it calls, threads for what has threads.
#                SANITIZER_CXX: clang 20 or newer, for rtsan and fuzz, too
#   make rtsan   builds with RealtimeSanitizer and runs the control loop: what allocates, locks or
#                waits in it ends the program. make rtsan-tests: without scenarios
#   make audit   looks up crates and the page's packages in advisory databases, where they answer
#   make headers checks that every header compiles alone
#   make lint    checks names and some common mistakes (clang-tidy)
#   make fuzz    feeds everything that reads what others have written, and the solver, with
#                FUZZ_SECONDS=600 of random bytes each, under sanitizers. What it finds is in build/fuzz/; FUZZ_TARGETS="config urdf" for some of them
#   make franka  runs the driver of the Franka against franka-sim, an independent server, and compares
#                it with pylibfranka, the maker's client, in an environment of their own (180 MB).
#                FRANKY=1: against franky-sim, too (660 MB)
#   make foxglove  opens the live interface of a run in the last open Foxglove Studio, in a headless
#                browser, and uses it (36 MB, once)
#   make notebooks
#                executes the notebooks of examples/notebooks as Jupyter does, reads exports by pandas,
#                pyarrow and h5py, and records streams by LabRecorder, in an environment of their own
#                (450 MB). Writes the .ipynb files from the .py files beside them
#   make ros2    runs the bridge to ROS 2 against rclpy of Jazzy and Kilted, in environments of their own
#                (240 MB each), and a robot of ROS 2 as a device. MINUTES=30 measures rates and losses for
#                so long instead
#   make pictures
#                draws runs as other tools have them (pandas, LabRecorder, Jupyter, ROS 2) for docs/images, in
#                the environments of make notebooks and make ros2
#   make ros1    builds the ROS 1 bridge against Debian's ROS 1 and tests it by rospy and rviz under a
#                virtual screen, in real time; as root it installs what is missing (300 MB).
#                PICTURE=FILE.png keeps the picture of rviz
#   make sweep-engines
#                runs a sweep on a Dask cluster, one worker of which is killed, and on a Slurm node of
#                its own (root, slurm-wlm), and compares: same hashes, same Parquet (250 MB)
#   make docs    writes the pages and tables that are generated from the code (tools/pages), and
#                builds docs/ with API pages as a searchable site: build/site/index.html
#   make soak    plays scenarios for SOAK_HOURS=30 of simulated time as fast as it goes, and looks at
#                memory, faults and limits; a restarted soak continues where it was (tools/soak.py)
#   make soak-machines
#                drives each simulated machine in real time for MINUTES=60, all at once: over UDP, over
#                EtherCAT, a Franka; MACHINES="udp ethercat" for some of them. BUSY=1: what is late is
#                counted and ends no run
#
# JOBS=2: compilers or tests at a time; default: the number of processors.

ARGS ?=
JOBS ?= $(shell nproc)
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
# tests wait for each other, for browsers and for time: half as many again
export CTEST_PARALLEL_LEVEL := $(shell expr $(JOBS) \* 3 / 2)
PRESET ?= release
BUILD := build/$(PRESET)
ASAN_TESTS := $(addsuffix _test, core limits hqp estimation rendering surfaces prepositioning tracking safety \
  collision passivity controller person simulator faults udp franka identify analysis doctor messages \
  recording live lab_streaming fuzz_replay)
TSAN_TESTS := $(addsuffix _test, core runtime recording lab_streaming viewer_server)
RTSAN_TESTS := $(addsuffix _test, controller runtime)
FUZZ_SECONDS ?= 600
FUZZ_TARGETS ?= hqp_reader hqp_solver config urdf protocol commands live recording
SOAK_HOURS ?= 30
first_of = $(firstword $(foreach name,$(1),$(shell command -v $(name))) $(firstword $(1)))
SANITIZER_CXX ?= $(call first_of,clang++-22 clang++-21 clang++-20)
with_sanitizers = CC=$(subst clang++,clang,$(SANITIZER_CXX)) CXX=$(SANITIZER_CXX)
empty :=
space := $(empty) $(empty)
# run_tests,PRESET,NAMES: builds these tests and runs them
define run_tests
@$(with_sanitizers) tools/configure.sh $(1) test
@cmake --build build/$(1) --target $(2)
@ctest --test-dir build/$(1) --output-on-failure --no-tests=error \
  --tests-regex '^($(subst $(space),|,$(strip $(2))))$$'
endef

.PHONY: demo demo-build test-build build wheel deb docs format clean \
  test test-wheel test-packages check headers lint audit sanitize sanitizer-set-up rtsan rtsan-tests fuzz \
  franka foxglove ros2 ros1 notebooks pictures sweep-engines soak soak-machines \
  bench bench-instructions experiments arms

demo: demo-build
	@$(BUILD)/hapticgiant run $(ARGS)

demo-build:
	@tools/setup.sh build
	@tools/configure.sh $(PRESET) build
	@cmake --build $(BUILD) --target hapticgiant

build:
	@tools/setup.sh build
	@tools/configure.sh $(PRESET) build
	@cmake --build $(BUILD) --target programs

test-build:
	@tools/setup.sh test
	@tools/configure.sh $(PRESET) test
	@cmake --build $(BUILD)

test: test-build
	@PATH="$(CURDIR)/.venv/bin:$$PATH" ctest --test-dir $(BUILD) --output-on-failure --no-tests=error

# pack,wheel or deb: builds what it is made of, then packs it
define pack
@tools/setup.sh wheel
@tools/configure.sh $(PRESET) build
@cmake --log-level=ERROR $(BUILD) >/dev/null  # finds what set-up has just fetched
@cmake --build $(BUILD) --target hg_programs _core_stubs $(if $(filter deb,$(1)),programs)
@tools/make_$(1).sh build/$(1)
endef
# use_package,wheel, bare or deb,FILES: uses it as its user does
define use_package
@PATH="$(CURDIR)/.venv/bin:$$PATH" .venv/bin/python tests/packages/installed_test.py $(1) \
  $(BUILD)/hapticgiant $(2) build/$(1)_installed || [ $$? = 77 ]
endef
# test_package,wheel or deb,FILES: packs it again, compares, and uses it
define test_package
@tools/make_$(1).sh build/$(1)_again
@cmp build/$(1)/$(2) build/$(1)_again/$(2)
$(call use_package,$(1),build/$(1)/$(2))
endef

wheel:
	$(call pack,wheel)

deb:
	$(call pack,deb)

test-wheel: wheel
	$(call test_package,wheel,*.whl)

test-packages: test-wheel deb
	$(call test_package,deb,*.deb)
	$(call use_package,bare,build/wheel/*.whl)
	@tools/check_pip_install.sh

bench:
	@tools/setup.sh bench
	@tools/configure.sh $(PRESET) build
	@cmake --log-level=ERROR $(BUILD) >/dev/null  # finds what set-up has just fetched
	@cmake --build $(BUILD) --target programs
	@$(BUILD)/hapticgiant bench --out build/bench --docs docs/reports

experiments: build  # each one refreshes its page, also after one that is not as expected
	@failed=; run() { $(BUILD)/hapticgiant "$$@" --docs docs/experiments || failed="$$failed; $$*"; }; \
	run experiment all --law both --out build/experiments; \
	run experiment timing --out build/experiments; \
	run haptify --out build/experiments/haptify; \
	run haptify --goals --repetitions 16 --out build/experiments/goals; \
	run experiment contact; \
	$(BUILD)/hapticgiant faults --cases 300 --docs docs/reports || failed="$$failed; faults"; \
	[ -z "$$failed" ] || { echo "make experiments: not as expected$$failed" >&2; exit 1; }

arms: build
	@.venv/bin/python tools/compare_arms.py $(BUILD)/hapticgiant docs/reports/arms.md

franka: build
	@.venv/bin/python tests/franka/franka_test.py $(BUILD)/hapticgiant $(if $(FRANKY),--franky)

ros1: build
	@bridges/ros1/build.sh test
	@/usr/bin/python3 tests/ros1/ros1_test.py $(BUILD)/hapticgiant \
	  $(if $(PICTURE),--picture $(PICTURE)) $(ARGS)

foxglove: build
	@node viewer/test/foxglove/run.mjs $(BUILD)/hapticgiant build/foxglove $(PICTURE)

notebooks: build
	@tools/setup.sh test
	@tools/configure.sh $(PRESET) test
	@cmake --build $(BUILD) --target programs _core _core_stubs
	@.venv/bin/python tools/notebooks.py
	@.venv/bin/python tests/connect/notebooks_test.py $(BUILD) $(BUILD)/hapticgiant

ros2: build
	@.venv/bin/python tests/ros2/ros2_test.py $(BUILD)/hapticgiant $(if $(MINUTES),--minutes $(MINUTES))

pictures: build
	@cmake --build $(BUILD) --target _core _core_stubs
	@.venv/bin/python tools/draw_other_tools.py $(BUILD)/hapticgiant docs/images

sweep-engines: build
	@.venv/bin/python tests/sweep/engines_test.py $(BUILD)/hapticgiant

bench-instructions:
	@tools/setup.sh count
	@tools/configure.sh $(PRESET) build
	@cmake --build $(BUILD) --target bench_instructions
	@.venv/bin/python tools/count_instructions.py $(BUILD)/bench_instructions docs/reports/benchmarks_instructions.csv

sanitizer-set-up:
	@tools/setup.sh test
	@SANITIZER_CXX=$(SANITIZER_CXX) tools/setup.sh sanitize

sanitize: sanitizer-set-up  # a target of its own, so that the compiler that it installs is found
	$(call run_tests,asan,$(ASAN_TESTS))
	$(call run_tests,tsan,$(TSAN_TESTS))

rtsan-tests: sanitizer-set-up
	@$(with_sanitizers) tools/configure.sh rtsan build
	@cmake --build build/rtsan --target $(RTSAN_TESTS)
	@set -e; for name in $(RTSAN_TESTS); do build/rtsan/$$name --gtest_brief=1; done

rtsan: rtsan-tests
	@cmake --build build/rtsan --target hapticgiant
	@set -e; for scenario in door excavator free_space; do \
	  build/rtsan/hapticgiant run $$scenario --fast --no-viewer --no-recording; \
	done

fuzz:
	@SANITIZER_CXX=$(SANITIZER_CXX) tools/setup.sh sanitize
	@$(with_sanitizers) tools/configure.sh fuzz build
	@cmake --build build/fuzz --target $(addprefix fuzz_,$(FUZZ_TARGETS))
	@set -e; for name in $(FUZZ_TARGETS); do \
	  mkdir -p build/fuzz/inputs/$$name; \
	  build/fuzz/fuzz_$$name -max_total_time=$(FUZZ_SECONDS) -timeout=10 -max_len=65536 \
	    -rss_limit_mb=4096 -print_final_stats=1 -artifact_prefix=build/fuzz/$$name- \
	    build/fuzz/inputs/$$name tests/fuzz/corpus/$$name; \
	done

soak: build
	@.venv/bin/python tools/soak.py $(BUILD)/hapticgiant --hours $(SOAK_HOURS)

soak-machines:
	@tools/setup.sh test
	@tools/configure.sh $(PRESET) test
	@cmake --build $(BUILD) --target hapticgiant segment
	@.venv/bin/python tools/soak_machines.py $(BUILD)/hapticgiant --minutes $(or $(MINUTES),60) \
	  --machines $(or $(MACHINES),udp ethercat franka) \
	  $(if $(BUSY),--busy)

DOCS_VENV := build/docs_venv
$(DOCS_VENV)/bin/mkdocs: tools/requirements-docs.txt
	@python3 -m venv $(DOCS_VENV)
	@$(DOCS_VENV)/bin/pip install --quiet --require-hashes --no-deps --only-binary=:all: --requirement $<
	@touch $@

docs: $(DOCS_VENV)/bin/mkdocs
	@tools/setup.sh test
	@tools/configure.sh $(PRESET) test
	@cmake --build $(BUILD) --target hg_pages _core_stubs
	@.venv/bin/python tools/pages/pages.py $(BUILD)/hg_pages
	@.venv/bin/python tools/draw_rooms.py docs/images/rooms.svg
	@cmake --install $(BUILD) --component python --prefix build/docs_python >/dev/null
	@NO_MKDOCS_2_WARNING=1 $(DOCS_VENV)/bin/python -m mkdocs build >build/docs.log 2>&1 || { grep -v ^INFO build/docs.log; exit 1; }
	@echo "docs: build/site/index.html"

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

check:
	@git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
	@.venv/bin/python tools/check_modules.py
	@.venv/bin/python tools/check_citations.py
	@.venv/bin/python tools/house_rules.py

audit:
	@.venv/bin/python tools/third_party.py --audit

headers:
	@[ -f $(BUILD)/compile_commands.json ] || \
	  { tools/setup.sh build && tools/configure.sh $(PRESET) build; }
	@.venv/bin/python tools/check_headers.py $(BUILD) --jobs $(JOBS)

lint:
	@[ -f $(BUILD)/compile_commands.json ] || \
	  { tools/setup.sh test && tools/configure.sh $(PRESET) test; }
	@.venv/bin/python tools/lint.py $(BUILD) --jobs $(JOBS)

clean:
	rm -rf build viewer/dist
