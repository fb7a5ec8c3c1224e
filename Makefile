# raygrain in two commands on a bare Debian 12: `make demo` and `make test`. Everything else is here too: `make help`.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
RELEASE := build/release
ASAN := build/asan
PRESET = cmake --preset $(1) --log-level=WARNING
CTEST = ctest --output-on-failure -j $(JOBS)
# The tests that run under the sanitizers on every change: everything below the program.
CORE_TESTS := test_base test_geometry test_build test_heuristic test_trace test_accel test_rays test_io test_analyze test_verify

BENCH ?= --quick

.PHONY: help build demo study bench bench-dependencies rays-figures report-page report-page-test viewer viewer-test page-dependencies gallery \
        test test-full asan-test release-test pages-for-tests pages-if-possible tsan-test clang-test neon-test fuzz models coverage format check-format tidy \
        dependencies full-dependencies install clean

help:            ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*##/\t/' | expand -t 20

dependencies:
	@scripts/install-dependencies.sh build

full-dependencies:
	@scripts/install-dependencies.sh full

build: dependencies ## install what is needed, build library and program into build/release
	@$(call PRESET,release)
	@cmake --build $(RELEASE) -j $(JOBS) --target raygrain raygrain_cli
	@echo "The program is $(RELEASE)/bin/raygrain"

bench-dependencies:
	@scripts/install-dependencies.sh bench

bench: bench-dependencies ## against Embree on the same rays; BENCH="--json FILE" etc. are its options, --quick by default
	@$(call PRESET,release)
	@cmake --build $(RELEASE) -j $(JOBS) --target raygrain_bench
	@$(RELEASE)/bin/raygrain-bench $(BENCH)

THREADS ?= 1 2

rays-figures: ## rays with structure against Embree, on a quiet machine: half an hour; rewrites the tables in docs/performance-rays.md and README.md
	@$(MAKE) --no-print-directory bench BENCH="--suite rays --threads $(THREADS) --json build/rays.json"
	@scripts/rays_tables.py build/rays.json --into docs/performance-rays.md README.md

demo: build      ## build, then compare the paper's heuristics on a built-in city under a low sun
	@scripts/demo.sh $(RELEASE)/bin/raygrain build/demo

page-dependencies:
	@scripts/install-dependencies.sh pages

# The interactive pages: a folder of TypeScript each, bundled into one HTML file that the program fills.
PAGES := report-page viewer
TEMPLATES := $(RELEASE)/share/raygrain
page_sources = $(wildcard $(1)/*.html $(1)/*.ts $(1)/src/* $(1)/src/*/*)

report-page: $(TEMPLATES)/report-page.html ## the interactive page of `raygrain report`; needs the npm registry, nothing else does
viewer: $(TEMPLATES)/viewer.html ## the page of `raygrain view`; needs the npm registry, too

define page_rules
$(TEMPLATES)/$(1).html: $(1)/node_modules $(call page_sources,$(1))
	@cd $(1) && npm run --silent build
	@mkdir -p $$(@D) && cp $(1)/dist/index.html $$@
	@echo "raygrain now fills $$@"

$(1)/node_modules: $(1)/package-lock.json
	@$$(MAKE) --no-print-directory page-dependencies
	@cd $(1) && npm ci --silent && touch node_modules

$(1)-test: build $(1)
	@scripts/install-dependencies.sh browser
	@cd $(1) && npm test --silent -- ../$(RELEASE)/bin/raygrain ../build/$(1)-test
endef
$(foreach page,$(PAGES),$(eval $(call page_rules,$(page))))

report-page-test: ## the report in headless Chromium: every chart, hover, dark, print, phone; pictures in build/report-page-test
viewer-test: ## the viewer in headless Chromium, and its counts against the analyzer's; pictures in build/viewer-test

gallery: build viewer ## the pictures of the viewer in docs/img
	@scripts/install-dependencies.sh browser
	@cd viewer && node test/gallery.mjs ../$(RELEASE)/bin/raygrain ../build/gallery ../docs/img

# The paper's models, where a folder beside the checkout has them; without them the public scenes alone.
SCENES ?= $(wildcard ../shared/scenes)
STUDIES ?= paper corrected
STUDY := build/study

study: build pages-if-possible ## the paper's evaluation, sound and corrected, as build/study/report.html; SCENES=DIR, STUDIES="published areas ..."
	@for study in $(STUDIES); do \
	   $(RELEASE)/bin/raygrain study $$study $(if $(SCENES),--scenes $(SCENES)) --jobs $(JOBS) --out $(STUDY)/$$study || exit 1; done
	@$(RELEASE)/bin/raygrain report $(STUDIES:%=$(STUDY)/%) --out $(STUDY)/report.html --markdown $(STUDY)/report.md

test: dependencies ## everything a commit must pass: sanitizers on the core, then all tests in release
	@$(MAKE) --no-print-directory asan-test
	@$(MAKE) --no-print-directory release-test

asan-test:
	@$(call PRESET,asan)
	@cmake --build $(ASAN) -j $(JOBS) --target $(CORE_TESTS)
	@cd $(ASAN) && RAYGRAIN_TEST_SCALE=small $(CTEST) -R '^core\.'

release-test: pages-for-tests
	@$(call PRESET,release)
	@cmake --build $(RELEASE) -j $(JOBS)
	@cd $(RELEASE) && $(CTEST)

# Where node, npm's registry or a browser cannot be had, the test of the viewer says so and is skipped.
pages-for-tests:
	@scripts/install-dependencies.sh browser && $(MAKE) --no-print-directory viewer \
	   || echo "The viewer's page cannot be built or shown here: its test is skipped."

pages-if-possible:
	@$(MAKE) --no-print-directory viewer report-page \
	   || echo "The interactive pages cannot be built here: reports are static, and raygrain view lacks its page."

test-full: full-dependencies ## all of it: ThreadSanitizer, Clang, coverage, clang-tidy, the full ray counts
	@$(MAKE) --no-print-directory check-format
	@$(MAKE) --no-print-directory tidy
	@$(MAKE) --no-print-directory tsan-test
	@$(MAKE) --no-print-directory clang-test
	@$(MAKE) --no-print-directory neon-test
	@$(MAKE) --no-print-directory coverage
	@$(MAKE) --no-print-directory asan-test
	@$(call PRESET,release)
	@cmake --build $(RELEASE) -j $(JOBS)
	@cd $(RELEASE) && RAYGRAIN_TEST_SCALE=full $(CTEST)
	@$(MAKE) --no-print-directory report-page-test
	@$(MAKE) --no-print-directory viewer-test

tsan-test:
	@$(call PRESET,tsan)
	@cmake --build build/tsan -j $(JOBS) --target $(CORE_TESTS) test_study test_report
	@cd build/tsan && RAYGRAIN_TEST_SCALE=small $(CTEST) -R '^core\.|^study\.|^report\.'

clang-test:
	@$(call PRESET,clang)
	@cmake --build build/clang -j $(JOBS)
	@cd build/clang && $(CTEST)

neon-test:       ## the searches and their tests for 64-bit Arm, in an emulator
	@JOBS=$(JOBS) scripts/neon-test.sh build/neon

# A finding is a file in build/fuzz/findings: run build/fuzz/bin/fuzz_NAME on it, mend, add a row to a table test.
MINUTES ?= 5

fuzz: full-dependencies ## every fuzzer for MINUTES (default 5), JOBS at a time; a table, and an error where there is a finding
	@$(call PRESET,fuzz)
	@cmake --build build/fuzz -j $(JOBS)
	@scripts/fuzz.sh build/fuzz $(MINUTES) $(JOBS) $(FUZZERS)

# Instrumented programs write their counters, and complaints, under the limits that these tests set: they run elsewhere.
LIMITED_TESTS := ^cli\.(BadInput\.Outputs|Faults\.(FullDisks|ReadOnlyFolders|LittleMemory))$$

coverage:        ## line coverage of src/, as text and HTML in build/coverage
	@$(call PRESET,coverage)
	@cmake --build build/coverage -j $(JOBS)
	@cd build/coverage && find . -name '*.gcda' -delete && RAYGRAIN_TEST_SCALE=small $(CTEST) -E '$(LIMITED_TESTS)'
	@mkdir -p build/coverage/html
	@gcovr --root . --filter 'src/' --object-directory build/coverage --html-details build/coverage/html/index.html \
	   --print-summary --txt build/coverage/coverage.txt

models: build full-dependencies ## load every model of Debian's assimp-testmodels; the outcome is docs/models.md
	@scripts/check-models.sh $(RELEASE)/bin/raygrain > build/models.md
	@cp build/models.md docs/models.md

format:          ## clang-format on every source
	@scripts/sources.sh | xargs clang-format -i

check-format:
	@scripts/sources.sh | xargs clang-format --dry-run -Werror

tidy:            ## clang-tidy on the library and the program
	@$(call PRESET,clang)
	@scripts/sources.sh | grep -E '^(src|cli)/.*\.cpp$$' | xargs -P $(JOBS) -n 4 clang-tidy -p build/clang --quiet 2>/dev/null

install: build pages-if-possible ## install into PREFIX (default /usr/local)
	@cmake --install $(RELEASE) --prefix $(or $(PREFIX),/usr/local)

clean:           ## remove all builds
	@rm -rf build
