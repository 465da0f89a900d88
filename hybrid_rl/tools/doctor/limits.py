"""From where on a check speaks: ratios, shares and numbers of standard errors, all of them here.

None is fitted to a run: they were chosen by what they mean, with seeds 0 to 5, 10 to 13 and 100 of
the runs of scripts/broken_runs.py in view, which the table on the page does not show.
"""

from math import exp

ENOUGH = 100  # decisions or episodes of a statistic at least
ERRORS = 4.0  # standard errors by which a difference counts
CLIPPED = 0.1  # share of decisions at which an entry of the observation stands at its limit
DISTINCT = 10  # values of an entry up to which it is a flag or a level, and has no limit
SOONER = 0.1  # lag [decisions] of actions that hardly matters
LAGS = 5  # actions before a change of which each may have made it
OLDER = 1.0  # effect of all older actions over that of the newest one
RELATED = exp(-1)  # correlation of successive observations: one time constant in a decision
SLOW = 0.75  # quantile of it: the middle of the slower half, as positions among velocities
NOISE = 0.5  # share of an entry's change that the next decision takes back
UNSEEN = 0.5  # share of the change that observation and actions, or a model, do not predict
HISTORY = 0.5  # share of what is left that the last observation then predicts
LEAST = 0.005  # share of a change or reward that is left open, that does not matter
NOTHING = 0.25  # gain of an action without effect, over that of one with
TWO = 0.125  # variance that two means leave of the gains: half of what they leave of uniform ones
STRETCH = 5  # decisions of an episode in turn that are fitted, and predicted
SHORTEST = 2 * STRETCH  # median of the episodes' lengths, so that both are there
SAME = 0.5  # share of the terminations that come at one and the same decision
MOSTLY = 0.95  # share of the rewards that are negative, and of the ends that are terminations
SOME = 10  # terminations at least of which the share is taken
FIRST = 2  # decisions of an episode that ends as it begins
START = 0.5  # share of an episode's last observation that its first one predicts
INFLATED = 2.0  # variance of a linear model's prediction over that with many random decisions
BOTH = 10  # episodes at least that have what is compared: success and failure, start and end
PAID = 0.5  # a policy's higher reward after the time limit, over the reward's standard deviation
SUMMED = 2.0  # rewards in a value, before it must be larger than one of them
OUTWEIGHED = 10.0  # entropy that a decision is paid, over the reward's standard deviation
OFFSET = 100.0  # a reward's mean over its standard deviation
