from itertools import product

from evolution.search.randomness import Purpose, generator


def test_the_same_seed_purpose_and_generation_give_the_same_numbers():
    one, other = (generator(7, Purpose.TRIALS, 42).random(5) for _ in range(2))
    assert one.tolist() == other.tolist()


def test_no_two_purposes_generations_or_seeds_share_their_numbers():
    keys = list(product([0, 1, 2**32, 2**63 - 1], Purpose, [0, 1, 5999]))
    firsts = {generator(*key).random() for key in keys}
    assert len(firsts) == len(keys)


def test_the_numbers_never_change():
    """Stored runs can be rebuilt only while these stand."""
    names = ["INITIAL_GENOTYPES", "TRIALS", "PARENTS", "MUTATION", "CHAMPION", "EVALUATION", "RECORDING"]
    assert [Purpose[each] for each in names] == list(range(7))
    assert generator(7, Purpose.MUTATION, 42).random() == 0.2498559524989411
