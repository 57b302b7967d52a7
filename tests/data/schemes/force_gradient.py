"""Schemes with force gradients: exact coefficients, or the one that their source optimises and the others from the conditions."""

from mpmath import findroot, mpf, sqrt

from processed import exponential, product, words

TABLE = words((1, 1), 4)
# [B,[A,B]] in words of A = 0 and B = 1
BRACKET = {(1, 0, 1): mpf(2), (0, 1, 1): mpf(-1), (1, 1, 0): mpf(-1)}


def flow(sum_of_words):
    series = power = {(): mpf(1)}
    for n in range(1, 5):
        power = {word: value / n for word, value in product(power, sum_of_words, TABLE).items()}
        series = {word: series.get(word, 0) + power.get(word, 0) for word in series | power}
    return series


def defects(flows):
    """Words of a step less those of exp(A + B), up to four letters; kicks are (share of B, share of the bracket)."""
    series = {(): mpf(1)}
    for one in flows:
        parts = {(0,): one} if not isinstance(one, tuple) else {(1,): one[0]} | {
            word: value * one[1] for word, value in BRACKET.items()}
        series = product(series, flow(parts), TABLE)
    exact = exponential([mpf(1), mpf(1)], TABLE)
    return [series.get(word, 0) - exact.get(word, 0) for word in TABLE]


def omelyan_mryglod_folk():
    second = mpf("0.2470939580390842")
    flows = lambda a, c: [a, (second, 0), mpf(1) / 2 - a, (1 - 2 * second, c), mpf(1) / 2 - a, (second, 0), a]
    at = lambda word: list(TABLE).index(word)

    def conditions(a, c):
        words_of_three = defects(flows(a, c))
        return [words_of_three[at((0, 0, 1))], words_of_three[at((0, 1, 1))]]

    a, c = findroot(conditions, (mpf("0.08935804763220157"), mpf("0.006938106540706989")))
    assert max(map(abs, defects(flows(a, c)))) < mpf(10) ** -45
    return {"a": [a], "b": [second], "c": [mpf(0), c]}


def force_gradient():
    root = sqrt(mpf(3))
    return {
        "chin-4a": {"a": [], "b": [mpf(1) / 6], "c": [mpf(0), mpf(1) / 72]},
        "chin-4b": {"a": [(1 - 1 / root) / 2], "b": [], "c": [(2 - root) / 48]},
        "chin-4c": {"a": [mpf(1) / 6], "b": [mpf(3) / 8], "c": [mpf(0), mpf(1) / 192]},
        "omelyan-mryglod-folk-4": omelyan_mryglod_folk(),
    }
