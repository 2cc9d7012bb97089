"""Who may come in."""

import pytest

from mujoco_port.live.door import Door, door_for, is_loopback

OWN = {"Host": "127.0.0.1:8080"}


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "127.3.4.5"])
def test_on_this_machine_no_token_is_asked_for(host):
    assert door_for(host).token is None


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "example.org", ""])
def test_anywhere_else_a_fresh_token_is(host):
    first, second = door_for(host).token, door_for(host).token
    assert first is not None
    assert len(first) >= 32
    assert first != second
    assert not is_loopback(host)


@pytest.mark.parametrize(
    "target",
    ["/", "/socket", "/wrong/socket", "/secre/", "/secrett/", "//secret/", "/?token=secret", "/Secret/"],
)
def test_nothing_is_answered_without_the_token(target):
    assert Door("secret").path(target) is None


def test_behind_the_token_stands_the_path():
    assert Door("secret").path("/secret/") == "/"
    assert Door("secret").path("/secret/socket?x=1") == "/socket"
    assert Door(None).path("/main.js?x=1") == "/main.js"


@pytest.mark.parametrize(
    "origin", ["https://example.org", "null", "http://127.0.0.1:9090", "http://localhost:8080"]
)
@pytest.mark.parametrize("token", [None, "secret"])
def test_pages_of_other_origins_give_no_orders(origin, token):
    assert "another origin" in Door(token).refuses({**OWN, "Origin": origin})


def test_a_name_that_a_stranger_lets_lead_here_is_not_answered():
    assert "localhost and 127.0.0.1 only" in Door(None).refuses({"Host": "stranger.example:8080"})
    assert "localhost and 127.0.0.1 only" in Door(None).refuses({})
    assert Door("secret").refuses({"Host": "lab-machine:8080"}) == ""


@pytest.mark.parametrize("host", ["127.0.0.1:8080", "localhost:8080", "[::1]:8080"])
def test_this_machines_own_page_is_let_in(host):
    assert Door(None).refuses({"Host": host}) == ""
    assert Door(None).refuses({"Host": host, "Origin": f"http://{host}"}) == ""
