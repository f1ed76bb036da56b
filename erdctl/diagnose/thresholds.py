"""Every number by which a diagnosis decides, with what it is, what it decides and its origin.

"Origin: none" marks a number that was set by judgement and has been neither derived nor calibrated;
the issue on inference settles those. "Origin: budget" is a matter of time, not of truth. A test
holds that no other file of this room has numbers of its own that decide.
"""

from __future__ import annotations

# --- cross-validation ---------------------------------------------------------------------------

# Number of groups that are left out in turn, where the log has fewer records than that.
# Decides: how long a left-out part is.
# Origin: none; more groups cost time, fewer leave out more than one effect can do without.
CV_GROUPS = 24

# Length of a stretch [s], the unit whose mean squares are compared as if independent.
# Decides: the degrees of freedom of every t statistic over stretches.
# Origin: longer than the memory of the noise of load cells and amplifiers seen so far (0.1 s).
STRETCH = 0.8

# Factor by which effective stroke or speed of records of two kinds of motion differ, the same for
# a level of the duty; kinds that a log must have to be left out by them.
# Decides: which records are left out together.
# Origin: what is meant to be one motion or one level differs by a few per cent on a rig.
KIND_FACTOR, KIND_DUTY, MOTION_KINDS, CONTROL_KINDS = 1.25, 0.02, 2, 3

# Mean square on left-out groups over that with more effects, from which on these must lose clearly
# at kinds of motion left out: so many times the mean square there.
# Decides: whether effects go. Of a real damper with two motions six went that left 39 N on groups,
# for four that left 71 N, as at the other motion these left 86.6 N and those 88.0.
# Origin: none; below it the other motions alone decide.
DEAR, CLEARLY = 1.5, 1.2

# Records of a log from which on some are kept aside, and one of how many.
# Decides: whether a figure is of records that neither fit nor search has seen.
# Origin: none; fewer left would cost the search more than a twelfth of its statistics.
ASIDE_FROM, ASIDE_OF = 12, 6

# Distance of a duty from those of other records, over the largest duty, from which on it is far,
# and the part of the duties of a record that may be.
# Decides: whether a record tells what the others do not, and neither is kept aside nor left out
# whole. Of a real damper with one level a record the one at no current, left out, spoke against all
# laws of the speed: the others do not tell what is viscous and what yields.
# Origin: none; levels a tenth and more from the others', two of five and more of a record, are far.
DUTY_NEAR, DUTY_FAR = 0.05, 0.2

# Samples and steps of the fits without a kind of motion or some records, kinds at most, and how
# often records are left out so.
# Origin: budget.
CARRY_SAMPLES, STEPS_CARRY, MOST_KINDS, CARRY_FITS = 12_000, 12, 6, 12

# Part of the weight of the samples near a knot from which on a learned curve is told there by a fit
# that leaves others out, and part of its size with which a closed form begins in such a fit.
# Decides: whether a law only says which record is which.
# Origin: the first is that of the anchor of `least_squares`, below which a value stays where all
# data had it; the second need only be small, and not 0, where a shape has no slope.
TOLD, BEGUN = 0.05, 0.05

# Ridge of the jackknife, as a part of the weight of all data.
# Decides: how far a parameter moves that a left-out group alone determines.
# Origin: none; without it the step goes to infinity.
CV_RIDGE = 0.05

# Chance with which levels of records, a gain and a zero of each, may follow a law for nothing, and
# records from which on an effect is asked for more.
# Decides: whether what tells records apart has a name, and whether a law of it is learned.
# Origin: theory; 0.05, and some 200 laws are looked at. Of fewer records even a zero that all of
# them share would be no more than chance.
CHANCE_OF_LEVELS, LEVELS_FROM = 2.5e-4, 5

# Part of the force by which a change of a parameter as large as itself must change it.
# Decides: whether a parameter counts as one that could take of the levels of records.
# Origin: none; far above rounding, far below what shows.
MOVES = 1e-6

# Part of the mean square left, or of a misfit's, that a gain and a zero of each record take.
# Decides: whether that is said.
# Origin: most of it; of six nulls of the plant, white, AR(1) and pink, the most had 0.06.
LEVELS_SAID = 0.5

# Of a straight line of the gains of records over their order: its chance among records that are
# alike, what it changes the gain by from the first to the last, the degrees of freedom that the
# scatter about it has, and the part of the order that what the test set does not say already.
# Decides: whether the force is said to rise or fall in the order of the records.
# Origin: COURSE_CHANCE, that one log in a thousand is said to; a load cell holds 1 % and twice that
# is a drift; the others far from dividing by nothing.
COURSE_CHANCE, COURSE_LEAST, COURSE_FREE, COURSE_OWN = 1e-3, 0.02, 5, 0.1

# Part of a misfit's square that a fault in one record, or from one record on, takes: as it seems
# before anything is fitted with it, and in the end, with what else is then named.
# Decides: whether a second search is made for it; whether what that names is said.
# Origin: most of it in the end; a fit that has made up for a fault, and lacks more than that, sees
# 0.4 of one that takes all of it (a car with a yield force that is steep next to rest).
SEEMS_ONCE, SETS_IN_ONCE = 0.2, 0.5

# Likelihood ratio of a fault in one record, or from one record on, against none.
# Decides: whether a second search is made for it.
# Origin: of 150 nulls of the plant, of all kinds, 69 at most within a record (spikes; records that
# scatter had more, but from their beginnings on), of 12 healthy drives of a car 110; 0.8 N of 0.4 N
# of noise in a twentieth of the time has 4,900.
ONCE_RATIO = 200.0

# Part of its force that a damper has lost in some records from beginning to end, over the scatter
# of the gains of records beside that; and the scatter that is always reckoned with.
# Decides: whether that is a fault.
# Origin: a load cell holds 1 % from one record to the next, and nine times that is far beyond.
LOST_OVER_SCATTER, GAIN_HOLDS = 9.0, 0.01

# The same over the scatter of gains of a fit that lacks the fault, and maybe more.
# Decides: whether a second search is made for it.
# Origin: between a real damper whose drives differ in their frequency, and that lacks another law
# (1.7, mr_sine), and five cars of which some drives have a fault (3.4 to 35, seeds 430 to 436).
SEEMS_LOST = 2.0

# Duty over another that is held to be the same; part of a record's strokes that are halves of
# closed cycles where its motion is steady; and the part of the square of what a fault takes of some
# records that is at a duty of others, or above one with as much force, and under a motion of these.
# Decides: whether it is a fault, where it could be a law of the duty or of the motion.
# Origin: a yield force that grows like the duty has a twentieth more there; most of them.
SAME_DUTY, STEADY, TOLD_BESIDE = 1.05, 0.8, 0.5

# Of the square by which given parameters are worse than fitted ones, the part that a fault takes.
# Decides: whether it is said to be what has happened to the damper of those parameters.
# Origin: nearly all of it; what a fit takes beside is its noise and small changes of everything.
GIVEN_SHARE = 0.9

# Chance with which the best cut of gains that are only scatter goes as far, and how many are drawn.
# Decides: whether what may be a gain of the rig is a fault.
# Origin: convention; of four gains it takes 20 times their scatter, of six 9 (a car whose four
# records scatter by 10 %, seed 440, was said to have lost 14 % in three).
CHANCE_OF_A_CUT, CUTS_DRAWN = 0.02, 20_000

# Of what the best onset takes of a residual, the part that another must take.
# Decides: whether it is sought, where the best one begins in no record and with none.
# Origin: a ramp over three records, one of which shows nothing of the force, takes 0.4 % more than
# the fault of the one that shows it (a car, seed 415).
ONCE_NEARLY = 0.9

# Square of a force in a record, over that in the record that has most of it.
# Decides: from where on what a record says of a gain of it is counted.
# Origin: a hundredth in rms; without a duty there is nothing of a yield force.
TELLS_A_GAIN = 1e-4

# Records, those with most misfit, in each of which alone an onset is sought.
# Decides: whether a fault that is in one record and in no other is found.
# Origin: budget; a fault leaves most where it is.
ONCE_RECORDS = 3

# Effects that a search has found when it asks whether a fault that sets in once leaves nothing.
# Decides: how soon a search ends that cannot name the fault, and that another one has to follow.
# Origin: budget; the steps from there on take longer than all before (quarter_car, seed 75).
BEFORE_A_FAULT = 3

# Standard deviation of the gains of records, beyond their errors, that no rig is held to have.
# Decides: whether a rest of which the levels take most is a misfit.
# Origin: a load cell holds 1 % from one record to the next, and three times that is none of it.
RIG_GAIN = 0.03

# Mean square that is left of a record, or of a stretch of STRETCH, over that of the others, and
# over what its third differences are of theirs.
# Decides: from where on it is no noise.
# Origin: three times in rms; of 61 nulls of the plant (seed 1490000 on) the largest record has 2.8.
# Five times in rms of a stretch, since noise of a long memory changes more from one to the next: of
# 380 nulls of 19 kinds (seeds 1532000 and 1533000 on) the largest has 9.0, where samples are lost.
LOUD, LOUD_STRETCH = 9.0, 25.0

# Mean square over all samples, those without weight too, over that of a model that is worse where
# it is weighed, up to which this is no harm.
# Decides: whether a better model pays for its gain where records settle.
# Origin: the state before a record is unknown, and misses of it differ by less between models; one
# that had turned into something else missed 10,000 times as much.
PAYS = 2.0

# Part of a sampling step below which the lag T_d is over at once.
# Decides: whether the jackknife moves it.
# Origin: theory; exp(-20) is left by the next sample.
INSTANT = 0.05

# Relative cut-off of singular values of the jackknife's step.
# Decides: which directions the rest of the data do not determine.
# Origin: square root of the rounding of 64-bit sums, with a margin.
CV_SINGULAR = 1e-10

# Number of stretches of a log that have weight, at least.
# Decides: whether a log is too short to diagnose.
# Origin: none; a mean over fewer has no useful standard error.
LEAST_GROUPS = 5

# Records of a log that are left out whole, in turn, at least.
# Decides: whether it can be asked if a correction carries over to other records.
# Origin: with two, half of the data is left out.
LEAST_RECORDS = 3

# Range of the duty, and of the strokes' highest speeds over their largest, within which a log has
# one duty and one speed.
# Decides: whether one log can tell what is left out.
# Origin: the step of a duty that `bench.identifiability` asks for; a speed that a bench holds.
ONE_DUTY, ONE_SPEED = 0.02, 0.1

# Samples to either side of a turn of the motion, and range of nine tenths of all other speeds over
# the one in the middle, within which a log has one speed but for its turns.
# Decides: whether a law of the speed is told.
# Origin: half of the windows over which velocity is derived, 7 to 17 samples; that of a triangle,
# with noise, where a sine has 0.8.
TURNING, ONE_SPEED_BUT_TURNS = 4, 0.2

# Levels of duty and kinds of motion up to which a log cannot tell several effects.
# Decides: whether two names or more may be `explained`.
# Origin: the parameters of a law of the duty (k, beta) and of one of the motion (amount, scale),
# which so many conditions fit whatever the law.
FEW_DUTIES, FEW_MOTIONS = 2, 2

# --- doubtful samples ---------------------------------------------------------------------------

# Part of a recorded sample that may come from samples of uncertain direction.
# Decides: which samples a force channel that averages or delays leaves without weight.
# Origin: none; set by argument so that ramps at reversals keep weight.
DOUBTFUL_PART = 0.5

# --- comparing two hypotheses -------------------------------------------------------------------

# One-sided t statistic of the mean log ratio of squared cross-validated residuals, over stretches.
# Decides: whether one hypothesis is better than another.
# Origin: none; p = 2e-4 for one comparison of normal values, meant for some tens of them.
T_STRETCHES = 3.5

# The same over left-out groups.
# Decides: whether a gain that is clear by many stretches lies in more than one group.
# Origin: none; p = 0.07.
T_GROUPS = 1.5

# z of the energy test over noise, t over the groups and over the records in which the two differ,
# and the effective number of such groups at least.
# Decides: whether a gain is beyond chance that is large in few places.
# Origin: measured null, see `erdctl prove --nulls`.
Z_ENERGY, T_PLACES, LEAST_PLACES = 6.0, 3.0, 1.5

# The t statistic over stretches that a gain large in few places must have.
# Decides: whether the other places are left as they were.
# Origin: p = 0.07, as T_GROUPS.
T_ELSEWHERE = 1.5

# Part of logs whose records are alike and seem not to be.
# Decides: whether the records differ in a gain by more than noise makes them, so that what they
# agree on must be shown over them.
# Origin: p = 0.05.
UNLIKE_RECORDS = 0.05

# Part of what an effect takes of the mean square that does not lie in the two samples of a turn.
# Decides: whether the log resolves in time what an effect does.
# Origin: none; set on one log on which a compliance and a play that leave 0.3 and 0.6 % go unnamed,
# and ten times as much of each is named.
LEAST_ELSEWHERE = 0.01

# Sign flips of stretches, and the part of them whose largest statistic over all candidates of a
# step may lie beyond the critical value.
# Decides: how much more the best of many must show than a single one would have to.
# Origin: a step in 500 goes wrong, so that with four steps a null in a hundred is named.
FLIPS, FALSE_ALARMS = 4000, 0.002

# Relative reduction of the cross-validated mean square.
# Decides: whether a gain is worth a name.
# Origin: none.
LEAST_GAIN = 0.004

# Part of the misfit's square that all named effects take together, where they do not take all.
# Decides: whether a name is earned, or what stays may be the cause of all of it.
# Origin: more than they leave.
LEAST_TAKEN = 0.5

# Part of the square that all named effects take together; records from which on a law that does not
# carry over shows.
# Decides: whether a further name, in a log of few records, may be the error of another one's form.
# Origin: the force that a catalogue's law gives is right to a tenth; as many records as one may be
# left out of and still leave three.
FORM_PART, MANY_RECORDS = 0.01, 4

# Reduction of the cross-validated error over the range of the force.
# Decides: whether a gain may be the rounding of a simulation.
# Origin: simulations agree with an independent solution within 1e-4 of the range.
ROUNDING = 2e-4

# t statistic over stretches below which two hypotheses cannot be told apart.
# Decides: what is listed as equivalent.
# Origin: p = 0.05, two-sided.
T_TIE = 2.0

# --- processes --------------------------------------------------------------------------------

# Samples times effects from which the second that a process needs to start is worth it.
# Origin: budget.
WORTH_PROCESSES = 60_000

# --- forward selection --------------------------------------------------------------------------

# Samples of the thinned log among whose hypotheses is searched; the result is fitted to all.
# Origin: budget.
SEARCH_SAMPLES = 12_000

# Of the reduction of the mean square by the chosen effects, the part that a hypothesis of fewer
# effects must reach to be fitted to all samples beside them; and how many are.
# Decides: nothing by itself; on all samples the fewer effects must do at least as well.
# Origin: budget.
NEARLY_AS_MUCH, SIMPLER = 0.8, 2

# Of it: how many times as many samples a fast motion may have before stretches of it are left out,
# how many the others have, and the time [s] before each of these in which a damper forgets.
# Decides: from which size on an effect is found in a long log of a fast motion.
# Origin: budget; time constants of springs and yield forces, 5 to 50 ms, and four times as long.
TOO_MANY, IN_STRETCHES, FORGOTTEN = 4.0, 2.0, 0.2

# Of the thinned log: the longest step [s] next to a turn of the motion or a step of the duty, and
# the time [s] before and after them in which it counts; and that of several whose times overlap,
# of which all are kept or none.
# Origin: time constants of springs and yield forces, 5 to 50 ms, and ten times as long.
FINE_STEP, BEFORE, AFTER, RUN = 0.005, 0.01, 0.05, 0.5

# Part of the samples beyond which steps of the duty are no events; part of the motion's energy that
# the samples between follow, and how many of them a cycle.
# Origin: budget; a straight line over 1/20 of a cycle is off by 1 % of its amplitude.
STEPS_PART, FOLLOWED, PER_CYCLE = 0.05, 0.9, 20

# Hypotheses that are extended side by side, and the number of effects up to which they are.
# Decides: the width of the beam.
# Origin: budget; with a beam of one, pairs of which neither gains alone were missed.
BEAM, BEAM_DEPTH = 3, 3

# Effects in one model, at most.
# Origin: budget; more than the data of any damper so far have asked for, so that they end the
# search and the names do not depend on a limit.
MOST_EFFECTS = 12

# The same for a log of one duty and one speed.
# Decides: how far such a log is searched; its names are ones that it cannot tell.
# Origin: budget; in 60 such short logs the most that were named are three.
MOST_OF_ONE_LOOP = 4

# Part of the most promising effect's screened gain, and the number of effects in any case; part of
# what a chosen effect takes.
# Decides: which effects are fitted together with a parent's; which in the place of a chosen one.
# Origin: budget; the screen is a linear estimate, right within about a factor of two.
SCREENED_GAIN, SCREENED_LEAST = 0.4, 4

# Part of what is left that a yield force of more than the speed has to promise beside a spring.
# Decides: whether such a law is fitted there.
# Origin: a law that is there promises 0.44 to 0.78 of it (12 pairs of the plant); on the way of the
# search on an MR damper of which no effect is all, 0.03 to 0.26, and it failed at other motions.
BEHIND_SPRING = 0.4

# Single effects, the best first, that are tried in the place of a chosen one; how many are listed.
# Decides: which look-alikes are looked for.
# Origin: budget.
LOOK_ALIKES, LOOK_ALIKES_LISTED = 6, 2

# Steps of a search: of a hypothesis, of one that begins where another ended, of companions, of a
# look at a start, of the first fit.
# Origin: budget.
STEPS, STEPS_AGAIN, STEPS_TOGETHER, STEPS_RANKING, STEPS_BASE = 25, 12, 40, 4, 40

# Steps after which the starts of one search are compared, and the cost over that of the best beyond
# which one is given up.
# Origin: budget; of 136 fits to 12 logs of the plant none was lost by it that had been better than
# the model without the effect.
STEPS_LOOK, LOOK_BEHIND = 6, 1.5

# Chi-square by which a step has to lower the cost, or a search has ended.
# Decides: how far from its minimum a search may stop, in standard errors: 0.03.
# Origin: the square of that; at 0.01 a search in a flat valley ended early (0.2 % of the cost).
SETTLED = 1e-3

# Lag [s] that a log without steps of the duty may be fitted with.
# Decides: whether it is one of the fluid, or stands in for something else.
# Origin: theory; as long as records are given to settle, see `core.blocks.SETTLE`. Published lags
# of ER dampers end at 0.06 s, but what is asked here is asked only where nothing else is missing.
LONGEST_LAG = 0.3

# Misfit over noise, rms, up to which effects are searched for again with such a lag free.
# Decides: whether another search is worth its time; real dampers leave several times as much.
# Origin: budget.
LITTLE_BUT_NOISE = 1.0

# Error on records kept aside over that of the model without effects, below which some of the chosen
# effects hold, where all together do not.
# Decides: whether they keep their names; what some records choose among asks for more than a sign.
# Origin: none.
HOLDS = 0.9

# Part of what a plain form of an effect promises to leave, below which a richer one is fitted too.
# Decides: whether it is looked at before the plain one is found, in whose place it is tried anyway;
# and of what is left, where more than noise is, whether it has the name.
# Origin: budget, behind a spring every fit is a march; none for the name.
RICHER = 0.9

# Part of the mean square that fewer parameters may leave more of, beside not significantly more.
# Decides: what has the name of two that do as well. In few records, where a misfit is left, what
# leaves far more is not significantly worse.
# Origin: none.
AS_GOOD = 0.1

# Mean square in finer steps over that in those of a fit, of a piston that slips.
# Decides: whether a hypothesis is judged by finer steps.
# Origin: of 24 fits to a friction damper those that slip had 1.2, 1.5, 1.6 and 3.4 (one of them
# 1.005), those that do not 1.04 at most.
OF_STEPS = 1.1

# Starts of each companion that are combined, and combinations that are searched to the end.
# Origin: budget.
COMPANION_STARTS, COMPANION_BEST = 5, 3

# Time constant [s] and exponent with which searches of the paper's parameters begin afresh: first,
# second, and behind a compliance, whose place a lag takes.
# Origin: the middle and the ends of what ER dampers are published with (5 to 50 ms, 0.4 to 1).
FRESH, FRESH_SECOND, FRESH_SERIES = (0.05, 0.4), (0.01, 1.0), (0.005, 0.4)

# --- screening: the grid of starts --------------------------------------------------------------

# Parts of what the recording spans, for lengths, speeds and compliances.
# Origin: half a decade apart, since a search finds its way from a factor of two.
PARTS = (0.003, 0.01, 0.03, 0.1, 0.3)

# Multiples of a parameter's own start, where nothing in a log sets a scale.
# Origin: as above.
MULTIPLES = (0.1, 0.3, 1.0, 3.0, 10.0)

# The same for parameters of both signs.
SIGNED_MULTIPLES = (0.3, 1.0, -1.0)

# Parts of 1/stroke, of 1/stroke^2 and of 1/dissipated energy.
# Origin: the force changes by some tenths over the stroke or the test.
INVERSE_PARTS, INVERSE_SQUARE, INVERSE_NEGATIVE = (0.1, 0.5), 0.5, -0.3
ENERGY_PARTS = (0.03, 0.3)

# Starts of a time, from a sample to half of the longest record, and one more, in sampling steps.
# Origin: budget; a delay of a sample moves whole jumps, one of a part of it goes with the slope.
DELAYS, PART_OF_STEP = 6, 0.2

# Starts of an effect's grid, how many of them are searched from, and the factor by which these
# differ in some parameter.
# Origin: budget; neighbours on the finest grid are a factor of 1.32 apart.
MOST_STARTS, SEARCHED_STARTS, NEXT_START = 30, 2, 1.5

# Size of what a direction of the Jacobian adds to those before it, relative to the largest.
# Decides: what the present model can take of the residual, beyond which an effect must explain.
# Origin: smaller ones are rounding of one-sided differences.
BASIS = 1e-4

# Step of a parameter of a law that is smooth at its off value, in its unit.
# Origin: the rounding of a one-sided difference is a hundred-millionth of that.
SMOOTH_STEP = 1e-4

# Step of an added force that acts behind a spring, as a part of the range of the force.
# Origin: what is worth a name is as large; at a turn a spring answers a small friction otherwise.
ADDED_STEP = 0.03

# --- learned laws -------------------------------------------------------------------------------

# Knots of a curve that is looked at, and the part of the samples beyond its ends; how many there
# may be of a factor, and of an added force, which a fit has for less.
# Origin: budget; six follow one bend either way, and a curve that pays for them gets twice as many.
FEW_KNOTS, MANY_KNOTS, CURVE_ENDS = 6, 12, 0.005
MOST_KNOTS = 24, 48

# Step between values of a coordinate, over their range, from which on they are two levels; and the
# width of a level over the least such step.
# Decides: where the knots of a curve lie.
# Origin: none; clocks, converters and sums of floats write a level with less.
SAME_LEVEL, LEVEL_WIDTH = 0.005, 0.5

# Part of what the first law takes that a further one must.
# Decides: whether what a law leaves is another one, or the error of its own form.
# Origin: a curve of few knots is right to a fifth.
LAW_PART = 0.04

# What a law takes at most over what the cheap look at it promises.
# Decides: whether a further law is fitted at all.
# Origin: budget; up to 1.9 of 60 laws over two coordinates and one, 2.3 of small ones.
PROMISED = 2.5

# Part of the misfit's square that a law may leave before a name is thought to hide where it acts;
# part of what a curve promises to leave that a surface must, to be looked at first.
# Decides: whether laws are looked for in the place of names; whether curves come before surfaces.
# Origin: budget; what is hidden so leaves more than half of it.
HIDDEN, HALVED = 0.1, 0.55

# Part of the square of what a law in the place of names does to the force in which it may differ
# from what they did, and still be the same in another form.
# Decides: whether names stay, and what is learned comes beside them.
# Origin: none; of chains of many lengths for those of one (1552002, 1580209, 1580297, 1580399)
# 0.001 to 0.08, of names that stood in for other physics 0.11 to 1.4.
NAME_LEFT = 0.1

# Part of the range of its values at samples by which a surface may leave that where none lies.
# Decides: whether a law over two coordinates is one.
# Origin: none.
CORNERS = 0.5

# Rest at the beginning of records, which no fit weighs, over that behind it.
# Decides: a sentence alone, never a name.
# Origin: none.
BEGINS = 2.0

# Rest of all samples over that of those which a fit weighs, from which both are said.
# Decides: a sentence alone, never a name.
# Origin: none.
ALL_OVER_WEIGHED = 1.1

# Highest speed (that of all but a hundredth of the samples) at large deflections (beyond a quarter
# of the range from its middle) over that at any, below which nothing tests a model at both.
# Decides: a sentence alone, never a name.
# Origin: of a sine it is 0.87, of sines of all strokes at one highest speed as much.
SLOW, FAR_OUT, ALMOST_ALL = 0.4, 0.25, 0.99

# Part of a term of the paper's model that a law must leave, in rms and either direction.
# Decides: whether it corrects the term, or takes its place and its growth beyond the range seen.
# Origin: of a term that still acts tens of per cent are left, of one replaced hundredths.
TERM_LEFT = 0.1

# Time constants of what rings: their number, the shortest over the step of a sample, and the
# longest over the longest record.
# Origin: they are a fourth apart, as wide as a resonance of a damping of a tenth; a period is six
# times as long, and four of them in a record show.
RING_TIMES, RING_STEPS, RING_LONGEST = 20, 0.5, 0.04

# Kinds of motion that are left out in turn where every record is of its own.
# Decides: whether a law holds at another stroke or speed than those that it was learned at.
# Origin: two would leave a half to learn from; of four, one may lie within the others.
COARSE_KINDS = 3

# Scatter over kinds of motion, left out in turn, of what a law gains, at least: of the logarithm of
# the mean square.
# Decides: whether a law may fail at the next kind of motion, where few, near ones gain alike.
# Origin: 0.3 to 0.9 over six kinds (fixtures/PROOF.md); three near ones of a friction damper have
# 0.02 to 0.06, and at another stroke the law that gained 14 or 22 % on each lost 7 and 4.
NEW_KIND = 0.3

# Samples by which laws are screened, some hundreds of them.
# Origin: budget; a curve has few values.
LAW_SAMPLES = 4_000

# Part of the rest that a curve over one coordinate must promise to take, or else laws over any two
# coordinates are looked at.
# Origin: what has one coordinate is taken by a curve over it.
MOST_OF_IT = 0.5

# Knots of either coordinate of a law over two; laws of those that are screened that are fitted; the
# part of what the best curve leaves that one over two must promise to take; and of what many knots
# of a curve could take from which on few are as good.
# Origin: budget; the last two none.
KNOTS_ACROSS, SURFACES_FITTED, WIDER, AS_FEW = 4, 2, 0.1, 0.9

# Points of a curve as documents give it, and those among which its words look for its ends.
# Origin: budget.
CURVE_POINTS, CURVE_WORDS = 33, 1025

# Part of a curve's range by which it may go beyond its ends and be told by them, and of its largest
# size below which a value is said as 0.
# Origin: none; they decide words only.
FLAT, NONE_OF_IT = 0.01, 1e-3

# Time constants of a memory that are tried, the shortest in steps of the log; of one that goes by
# the way the shortest travel, over the stroke.
# Origin: budget; the fit moves them.
LATE_TIMES, LATE_STEPS, LEAST_OF_STROKE = 6, 5.0, 3e-3

# Closed forms that are fitted of those like a curve; starts of each of their parameters; and what
# is left at least of a factor in the place at which it is taken to be 1.
# Origin: budget; none; less is a sign that turns.
FORMS_FITTED, FORM_STARTS, LEAST_FACTOR = 4, 8, 0.05

# Size, of a factor or of the range of the force, and phases in turns, from which a law is fitted
# that swings at the frequency of a line.
# Origin: budget; its sign turns the phase by a half.
SWING, PHASES = 0.05, (0.0, 0.125, 0.25, 0.375)

# Laws that are fitted of those that are screened, effects that are fitted in the place of one, and
# laws that one model may learn.
# Origin: budget.
LAWS_FITTED, NAMES_FITTED, MOST_LAWS = 5, 3, 3

# --- record effects (a gain and an offset of each record) ---------------------------------------

# Rounds of alternating least squares, and the part of its error by which a value may still move.
# Origin: budget.
RECORD_ROUNDS, RECORD_SETTLED = 12, 0.1

# Gain of a record, at least.
# Decides: whether a record would be noise that is blown up.
# Origin: none.
LEAST_RECORD_GAIN = 0.2

# --- lack of fit --------------------------------------------------------------------------------

# Folds, and samples that a regression learns from.
# Origin: budget.
FOLDS, REGRESSION_SAMPLES = 5, 12_000

# Trees, learning rate, leaves, bins of an input, samples of a leaf, penalty of the boosting.
# Decides: how fine a dependence on the state is seen.
# Origin: measured: 60 trees of 24 leaves at a rate of 0.12 with 255 bins have the same t statistics
# on 13 faint misfits (median of the ratios 0.98), and take nearly twice as long.
TREES, RATE, LEAVES, BINS, LEAF, PENALTY = 40, 0.18, 16, 64, 60, 10.0

# t statistics over stretches and over groups by which a predicted part must reduce the residual,
# and its share of the square.
# Decides: whether a lack of fit is significant.
# Origin: as T_STRETCHES and T_GROUPS; the share: none.
T_PREDICTED, T_PREDICTED_GROUPS, SHARE_PREDICTED = 3.5, 1.5, 0.01

# The same for a hint, and root mean square over the robust scale of a residual with heavy tails.
# Decides: whether a further search is worth while; no verdict rests on it.
# Origin: budget.
T_HINT, SHARE_HINT, HEAVY_TAILS = 1.0, 0.003, 1.1

# t statistic over groups of the log ratio of the residual variance in the states of the damper
# where it is large to that where it is small, and the root of that ratio at least.
# Decides: whether the residual variance depends on the state.
# Origin: none.
T_VARIANCE, VARIANCE_RATIO = 3.0, 1.2

# Part of the samples, those of the least expected variance, whose mean square is the noise.
# Origin: none.
NOISE_PART = 0.2

# Samples of a state in a group, groups, and floor of a logarithm as a part of the mean square.
# Origin: none.
STATE_SAMPLES, STATE_GROUPS, LOG_FLOOR = 20, 3, 1e-3

# What the regression is given of the past [s], and where times [s] and travel [m] since an event
# end.
# Origin: lags of ER fluids and amplifiers (1 to 100 ms).
LAGS, LONGEST_SINCE, FARTHEST_SINCE = (0.01, 0.05), 10.0, 1.0

# Time constants with which it is given the duty of late [s].
# Origin: charge and chains of ER fluids, which form and age within seconds; without it a leakage of
# 1.3 s under 64 levels of duty passed for noise of four times the true one (1241002).
MEMORIES = (0.3, 1.0, 3.0)

# Misfit over noise up to which a lack of fit counts as noise; the part of what the paper's model
# misses, in mean square, from which it counts where noise is larger.
# Decides: `unexplained`.
# Origin: none.
MISFIT_OVER_NOISE, MISFIT_PART = 0.3, 0.05

# --- a spectral line that turns over with the motion --------------------------------------------

# Share of the square; height over the median around it, of so many bins; share over that of the
# line in the residual itself; lowest bin.
# Decides: whether there is a ripple of the yield force.
# Origin: none; white noise of 1e5 bins has its highest line at about 12 times its mean.
LINE_SHARE, LINE_HEIGHT, LINE_AROUND, LINE_OVER_PLAIN, LINE_LOWEST = 0.1, 50.0, 401, 2.0, 10

# --- lines over travel --------------------------------------------------------------------------

# Samples of a stroke at least, points of a spectrum over travel, strokes at least, cycles that a
# usual one holds at least; part of a wave number around it with which it is compared, and cycles of
# a usual stroke either way that are its own.
# Decides: over which strokes and wavelengths a line is looked for.
# Origin: budget; a slope within a stroke has no line of six cycles.
TRAVEL_LEAST, TRAVEL_BINS, TRAVEL_STROKES, TRAVEL_CYCLES = 16, 512, 8, 6.0
TRAVEL_AROUND, TRAVEL_WIDTH = 0.35, 2.0

# Height of a line over the median around, and its share of the residual's square.
# Decides: whether what is left comes again with the travel.
# Origin: null; of 60 nulls the highest has 2.4.
TRAVEL_HEIGHT, TRAVEL_SHARE = 4.0, 0.1

# --- impulses -----------------------------------------------------------------------------------

# Innovation over the robust scale; impulses and groups with any, at least.
# Decides: what counts as an impulse.
# Origin: 6 standard deviations of a normal noise happen once in 5e8 samples; the counts: none.
IMPULSE_SIGMAS, IMPULSES_LEAST, IMPULSE_GROUPS = 6.0, 8, 3

# Order of the autoregressive model of the residual.
# Origin: more would learn the beat of a regular saw-tooth.
IMPULSE_ORDER = 2

# Samples next to a reversal, a duty step or the start of a record; part of the rms speed.
# Decides: where a model may jump itself, so that no impulse is counted.
# Origin: none.
IMPULSE_NEAR, IMPULSE_SLOW = 4, 0.2

# Part of an innovation that stays in the mean of so many samples after it over as many before.
# Decides: what is an impulse and what a spike.
# Origin: none.
IMPULSE_STAYS, IMPULSE_AFTER = 0.5, 3

# Share of the square of all innovations and of those beyond IMPULSE_SIGMAS; steps of the channel.
# Decides: whether impulses are reported.
# Origin: none.
IMPULSE_SHARE, IMPULSE_MOSTLY, IMPULSE_QUANTA = 0.1, 0.5, 3.0

# --- where and what it looks like ---------------------------------------------------------------

# Share of the misfit's energy in a region, that share less the region's part of the time, cells of
# equal time, part of the time beyond which a region says nothing, regions that are listed.
# Decides: where a misfit is located.
# Origin: none.
REGION_SHARE, REGION_EXCESS, REGION_CELLS, REGION_WIDEST, REGIONS = 0.5, 0.2, 200, 0.6, 3

# Share less part of the time by which an interval on either side is more than one interval.
# Decides: whether both ends of a stroke, or both directions, are told apart.
# Origin: half of REGION_EXCESS, so that two sides alike have together what one must have.
REGION_SECOND = 0.1

# Quantiles between which the range of a variable is taken, of which a region may be REGION_WIDEST.
# Decides: which regions are too wide to point at anything.
# Origin: none; a few samples at the ends of a transient are no range.
REGION_RANGE = (0.002, 0.998)

# Share less part of the time of a place that goes first because of the physics that is named there,
# over that of the sharpest place.
# Decides: which of the two is listed first.
# Origin: none.
REGION_OWN = 0.5

# Share of a misfit that nothing explains from which the one record that has it is listed first.
# Decides: whether a record or a place in the motion and the control comes first.
# Origin: none; a record that was recorded with its axes reversed had 1.00.
RECORD_FIRST = 0.9

# Intersection over union of two intervals of one variable.
# Decides: which of them are one place, that is listed once.
# Origin: none.
REGION_SAME = 0.5

# Digits of a duty that tell levels apart where a misfit gathers.
# Origin: no amplifier is finer; levels that differ by the last digits of a unit are one.
DUTY_DIGITS = 6

# Correlation with a simple form of motion and control; fading of one of them [s].
# Decides: whether a resemblance is reported.
# Origin: none.
RESEMBLANCE, RESEMBLANCE_FADING = 0.5, 0.05

# --- the drive that tells look-alikes apart ------------------------------------------------------

# Length [s], sampling rate and frequencies [Hz], parts of the stroke, part that settles.
# Origin: what benches run.
DRIVE_SECONDS, DRIVE_RATE = 4.0, 500.0
DRIVE_FREQUENCIES, DRIVE_STROKES, DRIVE_SETTLES = (0.2, 0.5, 1.0, 2.0, 5.0, 10.0), (1.0, 0.2), 0.25

# --- strokes whose force motion and control do not tell -------------------------------------------

# Parts of the way of a stroke, each with its own part of the force.
# Decides: whether a force that is more at first and less at last is seen.
# Origin: none.
UNLOGGED_PARTS = 3

# Strokes in a row, and as many others; all strokes of a group that are not alike; samples of a part
# of one; part of the usual way that a stroke goes.
# Decides: what is compared.
# Origin: two of each tell a scatter; of what is not alike, the motion must be seen to overlap.
UNLOGGED_FEWEST, UNLOGGED_UNLIKE, UNLOGGED_SAMPLES, UNLOGGED_WAY = 2, 10, 4, 0.5

# Parts of the record's range by which the speeds of like strokes differ at most, and where they
# begin; a duty may differ by ONE_DUTY.
# Decides: which strokes are alike.
# Origin: what a bench holds.
UNLOGGED_ALIKE, UNLOGGED_BEGIN = 0.05, 0.02

# Part of the force that strokes have of their own; chance of that in any strokes of the log; gap
# between them and the others over the largest among either.
# Decides: whether something acts that is not logged.
# Origin: none named in 80 logs of noise with a memory of 0.5 to 10 s, while a zero is told from a
# force that turns over with the motion; see UNLOGGED_SIGMAS.
UNLOGGED_PART, UNLOGGED_CHANCE, UNLOGGED_GAP = 0.05, 1e-4, 2.0

# Times its error that it is at least: in two parts of the way, and in one alone.
# Decides: the same; the chance is that of normal errors, and those of strokes have longer tails.
# Origin: of 880 nulls of 19 kinds the largest that were apart in two parts had 6.7 and 8.0, and of
# one part alone 12.9, of a burst of noise.
UNLOGGED_SIGMAS, UNLOGGED_ALONE = 9.5, 15.0

# Part of the force that those have who are apart in one part of the way alone.
# Decides: the same.
# Origin: of 1,260 nulls the largest, of four, had 0.101; a setting that turned within a stroke of a
# real damper made 0.34.
UNLOGGED_PART_ALONE = 0.2

# Times that the ones are farther from the others without a stroke at an end, so that it is one in
# which the change begins or ends.
# Origin: a stroke that is half changed makes it twice and more, one that is not a tenth.
UNLOGGED_EDGE = 1.5

# Part of it that strokes the other way have of the same sign in newtons, from which it is a zero.
# Origin: half way between a force of one direction alone, 0, and a zero, 1, or a little less.
UNLOGGED_ZERO = 0.4

# Of a force that stays about a level where the model goes on: what it gains over the model, over
# the square of the noise and as a part of all misfit; part of the samples at most; visits; the
# largest scatter about it, over the noise; the largest part of what is viscous, and of the rest,
# that may show in it, with twice its error; how nearly the two may be one.
# Decides: whether the range of the force channel ends there.
# Origin: of 80 drawn dampers (seeds 2031000 to 2031079) the clipped one has gains of 1,700 and
# more, 10 % of the misfit, parts below 0.07, and a scatter below that of the noise; of the others
# with a gain above 200 and as little scatter the least part is 0.42 (2031066, 1 % of the misfit),
# and the limit of it is half way between. The other limits lie between the two, or are judgement.
CEILING_GAIN, CEILING_SHARE, CEILING_PART, CEILING_VISITS = 200.0, 0.05, 0.5, 6
CEILING_NOISE, CEILING_SLOPE, CEILING_COND = 1.25, 0.25, 1e6

# Distance below the level [noise] within which a sample is at it where so many follow each other.
# Decides: what is left out of fits there.
# Origin: nearly all of what noise makes of the level; three samples as for a limit of the recorder.
CEILING_NEAR, CEILING_RUN = 3.0, 3

# Of them that the words tell; all are in the document.
# Origin: what a reader takes in.
UNLOGGED_SAID = 4

# --- what could have been missed ------------------------------------------------------------------

# Shapes of an effect of which the middle one is reported, and sizes that are tried along each.
# Decides: the size from which an effect would have been seen.
# Origin: budget.
SIZE_SHAPES, SIZES_TRIED = 3, 7

# Factor between sizes that are tried first, how many of them either way, and the logarithm to which
# a size is sought.
# Origin: budget; sizes are sought to a tenth, less than the scatter of what noise hides.
SIZE_STEP, SIZE_STEPS, SIZE_CLOSE = 2.0, 12, 0.1

# Factor on the size that is just seen.
# Decides: the size that is told.
# Origin: (3.5 + 1.645) / 3.5: a normal t statistic that is expected so much above 3.5 is below it
# once in twenty.
SIZE_SURE = 1.5

# Effects that were not named of which the words say from which size they would have been seen.
# Origin: what a reader takes in; the rest is in the document.
UNDETECTED_SAID = 3
