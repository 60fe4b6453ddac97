# Set-up is two commands: `make verify` (the main job) and `make test`.
# Everything builds with the one release profile. What tests alone depend on asks more features of packages that all use
# (approx, bitflags, once_cell): commands are built beside a test, as `make test` has them, or the library would be built twice.
CARGO ?= cargo
PACKAGES = -p bearing-dynamics -p verification -p bearing-fmu
VERIFY = $(CARGO) build --release --locked -q $(PACKAGES) --bins --test single_thread && "$${CARGO_TARGET_DIR:-target}/release/verify"

.PHONY: verify verify-full test golden conformance conform fmu bench pareto mutants doc lint fuzz

## Benchmarks of the source against independent oracles; report in target/verify.
verify:
	$(VERIFY) --tier smoke --jobs 2

## The same with the long cases; writes docs/verification.md.
verify-full:
	$(VERIFY) --tier full
	"$${CARGO_TARGET_DIR:-target}/release/verify" page

## Laws, command line, scene reader, golden values; what had to be skipped is said last.
SKIPPED = "$${CARGO_TARGET_DIR:-target}/skipped.txt"
test:
	@rm -f $(SKIPPED)
	@status=0; $(CARGO) test --release --locked $(PACKAGES) || status=$$?; \
	if [ -s $(SKIPPED) ]; then printf '\nNot all was tested:\n'; sort -u $(SKIPPED); fi; exit $$status

## Record new golden values: make golden CASE=misalignment_moment REASON="why they changed"; CASE=asymmetric for the asymmetric scenes
golden:
	$(if $(filter asymmetric,$(CASE)),GOLDEN_REASON="$(REASON)" $(CARGO) test --release --locked $(PACKAGES) --test command asymmetric_scenes,$(VERIFY) golden --case "$(CASE)" --reason "$(REASON)")

## The conformance set, as folders in target/conformance and as an archive of the same bytes at every build.
CONFORMANCE = target/conformance
conformance:
	$(CARGO) build --release --locked -q $(PACKAGES) --bins --test single_thread
	@rm -rf $(CONFORMANCE)
	"$${CARGO_TARGET_DIR:-target}/release/bearing" pack conformance/set.toml --jobs 2 --out $(CONFORMANCE)
	tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX -cf - -C target conformance | gzip -n9 > $(CONFORMANCE).tar.gz

## The form of all files of the set, what its packs find, three programs on its levels 1 and 2, one each on 3 and 4. PYTHON needs
## numpy, scipy, meshio, jsonschema.
PYTHON ?= python3
BEARING = "$${CARGO_TARGET_DIR:-target}/release/bearing"
ON_THE_SET = for level in $(3); do $(BEARING) conform $(CONFORMANCE) --level $$level --jobs 2 --fresh --out target/conform/$(1)-$$level --with $(2) || exit 1; done
conform: conformance
	$(CARGO) build --release --locked -q --manifest-path examples/fast/Cargo.toml --target-dir target/fast
	$(PYTHON) conformance/check_schemas.py $(CONFORMANCE) $(BEARING)
	$(PYTHON) conformance/check_packs.py $(CONFORMANCE) $(BEARING)
	$(call ON_THE_SET,bearing,$(BEARING)" {kind} {resolved} --out {out}",1 2)
	$(call ON_THE_SET,python,"$(PYTHON) conformance/example_python/candidate.py {kind} {resolved} {out}",1 2)
	$(call ON_THE_SET,fast,"target/fast/release/fast {kind} {resolved} {out}",1 2)
	$(call ON_THE_SET,solids,"$(PYTHON) conformance/example_python/solids.py {kind} {resolved} {out}",3)
	$(call ON_THE_SET,rotors,"$(PYTHON) conformance/example_python/rotors.py {kind} {resolved} {out}",4)

## A bearing as an FMU, checked by FMPy against runs. PYTHON needs fmpy.
fmu:
	$(CARGO) build --release --locked -q $(PACKAGES)
	$(PYTHON) examples/fmu/check.py $(BEARING) "$${CARGO_TARGET_DIR:-target}/release/make-fmu"

## Kernels under criterion; what an accuracy costs in motion; steps of solids, against plain loops and CalculiX (where installed); bounds fail.
bench:
	$(CARGO) bench --locked -p benches --bench statics --profile release
	$(CARGO) bench --locked -p benches --bench dynamics --profile release
	$(CARGO) bench --locked -p benches --bench solids --profile release
	$(CARGO) bench --locked -p benches --bench rubber --profile release
	$(CARGO) bench --locked -p benches --bench calculix --profile release

## Run time against error, as CSV and SVG in target/pareto.
pareto:
	$(VERIFY) pareto --out target/pareto

## Faults seeded in the physics, each to be caught by a test or a case. JOBS=n, ONLY=id.
JOBS ?= 1
mutants:
	$(VERIFY) mutants --jobs $(JOBS) $(if $(ONLY),--only $(ONLY))

## A million mutated scenes, mesh files and results of other programs, each, through their readers.
fuzz:
	SCENE_FUZZ_INPUTS=1000000 $(CARGO) test --release --locked $(PACKAGES) --test scene scene_fuzz -- --nocapture
	MESH_FUZZ_INPUTS=1000000 $(CARGO) test --release --locked $(PACKAGES) --test mesh mesh_fuzz -- --nocapture
	RESULTS_FUZZ_INPUTS=1000000 $(CARGO) test --release --locked $(PACKAGES) --test results_fuzz -- --nocapture

doc:
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --release --locked --no-deps --workspace

lint:
	$(CARGO) fmt --all --check
	$(CARGO) clippy --release --locked --workspace --all-targets -- -D warnings
