from __future__ import annotations

from studio.cli.commands.topic.rates import Rate, rate_table


def rate_of(period_s: float, count: int) -> Rate:
    rate = Rate()
    for number in range(count):
        rate.add(100 + number * period_s)
    return rate


def test_t3_several_topics_have_a_row_each_under_a_head():
    table = rate_table([("/scan", rate_of(0.1, 11)), ("/camera/image_raw", rate_of(0.25, 5))])
    assert table == (
        "      topic          rate    min_delta   max_delta    stddev   window\n"
        "=====================================================================\n"
        "/scan               10.000   0.100       0.100       0.00000   11    \n"
        "/camera/image_raw   4.000    0.250       0.250       0.00000   5     \n"
    )


def test_a_topic_without_a_rate_has_no_row_and_without_any_nothing_is_said():
    table = rate_table([("/silent", Rate()), ("/scan", rate_of(0.1, 3))])
    assert table is not None
    assert "/silent" not in table
    assert rate_table([("/silent", Rate())]) is None
