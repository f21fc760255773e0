# GPL v2 or later, see LICENSE.
"""Viscoplastic flow of concrete at a point: strength of the law without damage, in closed form, and what damage makes of it."""
import numpy as np

from yade.ddem import plots
from yade.ddem.materialpoint import MaterialPoint, concrete
from yade.ddem.verification import case, concrete_theory, tools

FLOW = {"viscoplasticFlow", "rateDependence"}  #: effects of the flow alone


def plateau(parameters, rate, confinement=0.0):
	"""Axial stress of a point without damage that has flowed to 3 % [Pa]."""
	end = MaterialPoint(parameters, effects=FLOW).uniaxial(rate=rate, until=np.copysign(0.03, rate), confinement=confinement, step=1e-6, every=30_000)
	return end.axial_stress[-1]


@case(group="concrete at a point", seconds=0.5)
def steady_flow(check):
	"""Steady flow without damage

	Strained for long, a point without damage flows at a constant stress. All strain is then that of the flow, ε̇ = ½ M_p ė_eq, and eq. 7 can be solved for the
	stress:

		σ_eq = σ_p0 (ė_eq/(Λ_0 ė_0 (ė_N/ė_0)^ω_p))^(1/n_p),   ė_N = ė_eq √(M_p:M_p/8)

	In tension it grows by the power (1 − ω_p)/n_p = 0.08 of the rate; under pressure friction decays, and the stress is the root of an equation in one unknown.

	Reference: Zubelewicz (2018), eqs. 5–7, with the closures for ė_N and q_D that ConcreteDamageMat names.

	Expect: the law, which takes the friction of the predictor, is first order in the step: 10⁻³ at 10⁻⁵ of strain, 10⁻⁴ at 10⁻⁶, which is taken here.
	"""
	parameters = concrete()
	up, down = np.array((0, 1, 0)), np.array((0, -1, 0))
	tests = [("tension", rate, 0, up) for rate in (1e-3, 1, 1e3)] + [("compression", -rate, 0, down) for rate in (1e-3, 1, 1e3)]
	tests += [("compression", -1, pressure, down) for pressure in (20e6, 40e6, 60e6)]
	for name, rate, confinement, direction in tests:
		expected = concrete_theory.steady_stress(parameters, direction, 1, rate, confinement)[1]
		what = f"{name} at {abs(rate):g} /s" + (f", confined by {confinement / 1e6:g} MPa" if confinement else "")
		check(f"{what} [Pa]", plateau(parameters, rate, confinement), expected, 2e-4, "steady flow in closed form")
	slow, fast = (plateau(parameters, rate) for rate in (1e-3, 1e3))
	check("power of the rate in tension [-]", np.log10(fast / slow) / 6, (1 - parameters["rateExponent"]) / parameters["flowExponent"], 1e-6, "(1 − ω_p)/n_p")
	rates = np.logspace(-6, 3, 10)
	found = {sign: np.array([abs(plateau(parameters, sign * rate)) for rate in rates]) for sign in (-1, 1)}

	def draw():
		fig, (ax,) = tools.axes(height=58)
		for sign, name, marker in ((-1, "compression", "o"), (1, "tension", "s")):
			exact = [abs(concrete_theory.steady_stress(parameters, (0, sign, 0), 1, sign * r)[1]) for r in rates]
			ax.loglog(rates, found[sign] / 1e6, marker, markersize=3, label=name)
			ax.loglog(rates, np.array(exact) / 1e6, "k-", linewidth=0.7, label="closed form" if sign > 0 else None)
		ax.set_xlabel("strain rate [1/s]")
		ax.set_ylabel("stress of steady flow [MPa]")
		tools.legend(ax, 3)
		return fig

	check.picture(draw, "Uniaxial stress at which a point without damage flows steadily, over nine decades of the rate.")


@case(group="concrete at a point", seconds=0.3)
def damage_growth(check):
	"""Damage grows with the work of flow

	The work of the flow is w = ∫ σ:ε̇_p dt = ∫ σ_eq ė_eq dt. With constant friction the directions of flow do not change in a uniaxial test, and eq. 8 says

		Ω = ½ M_c ξ_c0 w/G_f

	with ξ_c0 = 1 in an open crack and 0.5 in a closed one. The book of energies closes: stored + plastic + damage = work of the stress.

	Reference: Zubelewicz (2018), eqs. 6 and 8; the second law.

	Expect: 10⁻⁴ for the damage with steps of 10⁻⁶ (what is booked is the mean of two steps, what damages is the second); the energies to round-off.
	"""
	parameters = concrete(frictionPressureExponent=0)
	drawn = {}
	for name, sign, growth in (("tension", 1, 1.0), ("compression", -1, parameters["closedGrowth"])):
		result = MaterialPoint(parameters).uniaxial(rate=sign, until=sign * 0.02, step=1e-6)
		_, complementary = concrete_theory.flow_tensors(parameters, (0, sign, 0))
		# a closed crack grows at half the rate once it is one: σ_Ω < 0 needs damage first, so compare what comes after
		first = 2000
		work = np.diff(result.plastic_dissipation[[first, -1]])[0]
		grown = result.damage[-1] - result.damage[first]
		for axis, part in ((0, "across"), (1, "along")):
			expected = 0.5 * complementary[axis] * growth * work / parameters["fractureEnergy"]
			check(f"damage {part} in {name} [-]", grown[axis], expected, 1e-4, "Zubelewicz (2018), eq. 8")
		stress, strain = result.stress, result.strain
		done = (0.5 * (stress[1:] + stress[:-1]) * np.diff(strain, axis=0) * [1, 1, 1, 2]).sum()
		kept = result.stored_energy + result.plastic_dissipation + result.damage_dissipation
		check(f"energy found over the work in {name} [-]", (kept[-1] - kept[0]) / done, 1, 1e-10, "first law")
		losses = np.concatenate([np.diff(result.plastic_dissipation), np.diff(result.damage_dissipation)])
		lowest = min(losses.min() / losses.max(), 0)
		check(f"smallest dissipation of a step over the largest in {name} [-]", lowest, 0, 1e-12, "second law: never negative", scale=1)
		drawn[name] = np.abs(result.axial_strain), result.stored_energy, result.plastic_dissipation, result.damage_dissipation

	def draw():
		fig, panels = tools.axes(plots.PAGE, 58, panels=2)
		for ax, (name, (strain, *parts)) in zip(panels, drawn.items()):
			labels, colours = ("stored", "plastic flow", "damage"), [plots.COLOURS[i] for i in (5, 4, 1)]
			ax.stackplot(100 * strain, *(part / 1e3 for part in parts), labels=labels, colors=colours)
			ax.axhline(parameters["fractureEnergy"] / 1e3, color="k", linewidth=0.6, linestyle="--", label="$G_f$")
			ax.set_title(name)
			ax.set_xlabel("strain [%]")
			ax.set_ylabel("energy [kJ/m³]")
		panels[0].legend(loc="upper left")
		return fig

	check.picture(draw, "Energy per volume in uniaxial tension and compression at 1/s, constant friction.")
	check.note(
		"G_f is a scale, not the area below the curve: half of the strength is gone when the flow has done the work 2 G_f/|M_c| in an open crack, and the work goes on "
		"growing, slower and slower."
	)


@case(group="concrete at a point", seconds=2)
def strength_envelope(check, step=1e-5):
	"""Strength under two and three stresses

	Left: plane stress, both stresses growing in proportion, the larger of them strained at 1/s; right: confined compression. Lines are the closed form of steady
	flow without damage; circles are the peaks of the whole law, which damage keeps below it.

	Reference: steady flow in closed form, Zubelewicz (2018), eqs. 5–7. Beside it, for the eye: Kupfer, Hilsdorf and Rüsch (1969) and Richart, Brandtzaeg and
	Brown (1928).

	Expect: without damage within 0.3 % of the closed form everywhere, which is first order in the steps of 10⁻⁵.
	"""
	parameters = concrete()
	ratios = [(r, -1) for r in (0, 0.2, 0.4, 0.6, 0.8, 1, -0.05, -0.1, -0.2, -0.5)] + [(r, 1) for r in (0, 0.3, 0.6, 1, -0.5, -0.99)]
	peaks, largest = [], 0.0
	for ratio, sign in ratios:
		steady, _ = proportional(parameters, ratio, sign, FLOW, step)
		expected = concrete_theory.steady_stress(parameters, (ratio * sign, sign, 0), 1, sign)[1]
		largest = max(largest, abs(steady / expected - 1))
		peaks.append(proportional(parameters, ratio, sign, None, step)[1])
	check(f"plane stress, {len(ratios)} directions: largest relative difference [-]", largest, 0, 3e-3, "steady flow in closed form", scale=1)
	peaks = np.array(peaks)
	uniaxial, biaxial = -peaks[0, 1], -peaks[5, 1]
	confinements = np.linspace(0, 100e6, 6)
	confined = np.array([-MaterialPoint(parameters).uniaxial(rate=-1, until=-0.012, confinement=c, every=5).peak.stress for c in confinements])

	def draw():
		fig, (left, right) = tools.axes(plots.PAGE, 80, panels=2)
		near = np.add.outer((-135, -90, 0, 45), np.linspace(-4, 4, 41)).ravel()  # equal stresses, where the line turns sharply
		angles = np.radians(np.unique(np.clip(np.concatenate([np.linspace(-135, 45, 91), near]), -135, 45)))
		line = np.array([envelope_point(parameters, angle) for angle in angles]) / 1e6
		line = np.vstack([line, line[::-1, ::-1]])
		left.plot(line[:, 0], line[:, 1], "k-", linewidth=0.7, label="steady flow, closed form")
		for flip in (1, -1):
			left.plot(*(peaks[:, ::flip].T / 1e6), "o", color=plots.COLOURS[0], markersize=3, label="peak of the law" if flip > 0 else None)
		tests = -np.array(concrete_theory.KUPFER) * uniaxial / 1e6
		left.plot(*np.vstack([tests, tests[::-1, ::-1]]).T, "--", color=plots.COLOURS[1], linewidth=0.8, label="tests (Kupfer 1969)")
		left.set_aspect("equal")
		left.set_xlabel(r"$\sigma_1$ [MPa]")
		left.set_ylabel(r"$\sigma_2$ [MPa]")
		left.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
		axis = np.linspace(0, 100e6, 60)
		exact = [-concrete_theory.steady_stress(parameters, (0, -1, 0), 1, -1, c)[1] for c in axis]
		right.plot(axis / 1e6, np.array(exact) / 1e6, "k-", linewidth=0.7)
		right.plot(confinements / 1e6, confined / 1e6, "o", color=plots.COLOURS[0], markersize=3)
		tested = concrete_theory.richart(uniaxial, axis) / 1e6
		right.plot(axis / 1e6, tested, "--", color=plots.COLOURS[2], linewidth=0.8, label="$f_c$ + 4.1 $p$ (Richart 1928)")
		right.set_xlabel("confining pressure $p$ [MPa]")
		right.set_ylabel("axial strength [MPa]")
		right.legend(loc="lower left", bbox_to_anchor=(0, 1.0))
		return fig

	check.picture(draw, "Strength at 1/s under plane stress (left) and confined compression (right); lines of tests scaled to the uniaxial strength of the law.")
	check.note(
		f"A limit of the law: {uniaxial / 1e6:.0f} MPa belong to stress states with two equal lateral stresses only. There the two share the flow, M_p:M_p is smaller, "
		f"ė_N with it, and by its power ω_p/n_p = 1.92 the stress is larger by 1.9. A lateral stress of a few per cent brings the strength down to "
		f"{-peaks[1, 1] / 1e6:.0f} MPa, which is also that in plane strain; in equal biaxial compression it is {biaxial / 1e6:.0f} MPa, {biaxial / uniaxial:.2f} of the "
		"uniaxial strength, where tests have 1.16. The report compares with uniaxial tests only, and does not say how equal stresses share the flow."
	)


def proportional(parameters, ratio, sign, effects, step):
	"""Final stress [Pa] and (σ_x, σ_y) at the peak of a point under σ_x = ratio·σ_y, σ_z = 0, strained along y at 1/s; σ_x follows σ_y a step behind, except where
	both are equal by symmetry."""
	point, stresses = MaterialPoint(parameters, effects=effects), [(0.0, 0.0)]
	for strain in sign * np.arange(step, 0.006, step):
		lateral = {"strain": {"xx": strain}, "stress": {}} if ratio == 1 else {"strain": {}, "stress": {"xx": ratio * stresses[-1][1]}}
		try:
			end = point.path(step, strain={"yy": strain, **lateral["strain"]}, stress={"zz": 0.0, **lateral["stress"]}, steps=1)
		except RuntimeError:  # softening faster than the lateral stress is taken back; the peak is over
			break
		stresses.append(tuple(end.stress[-1, :2]))
	stresses = np.array(stresses)
	return stresses[-1, 1], stresses[np.argmax(np.abs(stresses[:, 1]))]


def envelope_point(parameters, angle):
	"""(σ_1, σ_2) [Pa] of steady flow in a direction of the plane of stresses, the larger stress strained at 1/s."""
	direction = np.array((np.cos(angle), np.sin(angle), 0.0))
	axis = int(np.argmax(np.abs(direction)))
	return concrete_theory.steady_stress(parameters, direction, axis, np.sign(direction[axis]))[:2]


@case(group="concrete at a point", seconds=0.2)
def rate_factors(check):
	"""Strength and strain rate, beside Model Code 2010

	Peaks of the whole law over the strain rate, in uniaxial tension and compression, each over the peak at the rate that the code calls static.

	Reference: peaks in tension of an independent implementation of the same closures (numpy). Beside them, for the eye and in the note: fib Model Code 2010,
	section 5.1.11.2: (ε̇/30·10⁻⁶)^0.014, above 30 /s 0.012 (ε̇/30·10⁻⁶)^⅓ in compression; (ε̇/10⁻⁶)^0.018, above 10 /s 0.0062 (ε̇/10⁻⁶)^⅓ in tension.

	Expect: the independent peaks within 0.5 %; the law, nearly a power of 0.08, lies above the code at moderate rates and below it at the highest.
	"""
	parameters = concrete()
	for rate, strength in ((1e-3, 5.94e6), (1e-1, 8.49e6), (1, 10.08e6), (10, 11.92e6), (1e3, 16.25e6)):
		found = MaterialPoint(parameters).uniaxial(rate=rate, until=0.003).peak.stress
		check(f"strength in tension at {rate:g} /s [Pa]", found, strength, 5e-3, "independent implementation of the same closures")
	rates = np.logspace(-6, 3, 19)
	factors = {}
	for tension, sign in ((True, 1), (False, -1)):
		strength = lambda rate: abs(MaterialPoint(parameters).uniaxial(rate=sign * rate, until=sign * 0.006, every=5).peak.stress)
		factors[tension] = np.array([strength(rate) for rate in rates]) / strength(concrete_theory.FIB_STATIC[tension])

	def draw():
		fig, panels = tools.axes(plots.PAGE, 58, panels=2, sharey=True)
		fine = np.logspace(-6, 3, 300)
		for ax, tension, name in zip(panels, (False, True), ("compression", "tension")):
			ax.semilogx(rates, factors[tension], "o", markersize=3, label="peak of the law")
			shown = fine[fine >= concrete_theory.FIB_STATIC[tension]]
			ax.semilogx(shown, concrete_theory.fib_factor(shown, tension), "k-", linewidth=0.8, label="fib Model Code 2010")
			ax.set_title(name)
			ax.set_xlabel("strain rate [1/s]")
		panels[0].set_ylabel("strength over static strength [-]")
		panels[0].legend(loc="upper left")
		return fig

	check.picture(draw, "Strength over strain rate, over the strength at the static rate of the code: 30·10⁻⁶ /s in compression, 10⁻⁶ /s in tension.")
	at = lambda tension, rate: float(np.interp(np.log(rate), np.log(rates), factors[tension]))
	check.note(
		"Factors of the law and of the code: " + ", ".join(
			f"{name} at {rate:g} /s {at(tension, rate):.2f} and {float(concrete_theory.fib_factor(rate, tension)):.2f}"
			for tension, name in ((False, "compression"), (True, "tension")) for rate in (1, 100, 1000)
		) + ". The law has one power, about 0.08, for all rates; the code 0.014 and 0.018 up to 30 and 10 /s, and ⅓ above."
	)
