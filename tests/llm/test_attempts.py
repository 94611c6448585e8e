"""The number of requests at once falls on 429 and comes back slowly."""

import asyncio

import pytest

from codriving.llm.attempts import ConcurrencyLimit


def test_no_more_than_the_limit_are_inside_and_all_get_through() -> None:
    async def crowd() -> tuple[int, int]:
        limit, inside, most, done = ConcurrencyLimit(3), 0, 0, 0

        async def one() -> None:
            nonlocal inside, most, done
            async with limit.slot():
                inside += 1
                most = max(most, inside)
                await asyncio.sleep(0)
                inside -= 1
                done += 1

        await asyncio.gather(*(one() for _ in range(20)))
        return most, done

    assert asyncio.run(crowd()) == (3, 20)


def test_requests_turned_away_together_halve_it_once() -> None:
    async def run() -> list[int]:
        limit = ConcurrencyLimit(16)
        async with limit.slot() as first, limit.slot() as second:
            limit.shrink(first)
            limit.shrink(second)
        limits = [limit.limit]
        async with limit.slot() as later:
            limit.shrink(later)
        return [*limits, limit.limit]

    assert asyncio.run(run()) == [8, 4]


def test_it_never_closes_and_grows_back_to_where_it_was() -> None:
    async def run() -> tuple[int, int, int]:
        limit = ConcurrencyLimit(4)
        for _ in range(5):
            async with limit.slot() as ticket:
                limit.shrink(ticket)
        low = limit.limit
        limit.grow()
        after_one = limit.limit
        for _ in range(50):
            limit.grow()
        return low, after_one, limit.limit

    assert asyncio.run(run()) == (1, 2, 4)


def test_one_who_gives_up_waiting_leaves_no_hole() -> None:
    async def run() -> bool:
        limit = ConcurrencyLimit(1)

        async def one() -> None:
            async with limit.slot():
                await asyncio.sleep(0)

        async with limit.slot():
            waiting = [asyncio.create_task(one()) for _ in range(3)]
            await asyncio.sleep(0)
            waiting[0].cancel()
        waiting[1].cancel()
        results = await asyncio.gather(*waiting, return_exceptions=True)
        async with asyncio.timeout(5):
            await one()
        return results[2] is None

    assert asyncio.run(run())


@pytest.mark.parametrize("most_at_once", [1, 2, 7])
def test_limit_is_kept_after_shrinking(most_at_once: int) -> None:
    async def run() -> int:
        limit = ConcurrencyLimit(most_at_once)
        async with limit.slot() as ticket:
            limit.shrink(ticket)
        inside = most = 0

        async def one() -> None:
            nonlocal inside, most
            async with limit.slot():
                inside += 1
                most = max(most, inside)
                await asyncio.sleep(0)
                inside -= 1

        await asyncio.gather(*(one() for _ in range(10)))
        return most

    assert asyncio.run(run()) == max(1, most_at_once // 2)


def test_an_answer_lets_in_one_who_waits_for_a_place_that_was_taken_away() -> None:
    async def run() -> tuple[list[str], list[str]]:
        limit, inside = ConcurrencyLimit(2), list[str]()

        async def one(name: str) -> None:
            async with limit.slot():
                inside.append(name)
                await asyncio.Event().wait()

        async with limit.slot() as ticket:
            limit.shrink(ticket)
            waiting = [asyncio.create_task(one(name)) for name in ("first", "second")]
            await asyncio.sleep(0)
            before = list(inside)
            limit.grow()
            await asyncio.sleep(0)
            after = list(inside)
        for task in waiting:
            task.cancel()
        await asyncio.gather(*waiting, return_exceptions=True)
        return before, after

    # One place of two was left, and taken; an answer makes them two again.
    assert asyncio.run(run()) == ([], ["first"])


def test_it_grows_by_one_a_round_of_answers() -> None:
    limit = ConcurrencyLimit(8)
    limit.shrink(0)
    limits = []
    for _ in range(20):
        limit.grow()
        limits.append(limit.limit)
    assert limits == [4, 4, 4, 4, 5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7]
