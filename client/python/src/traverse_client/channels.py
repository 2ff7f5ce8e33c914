"""How channels to a fleet are opened, sync and asyncio alike."""

import json
import random
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import grpc

Token = Union[str, Callable[[], str]]


def check_addresses(addresses: Sequence[str]) -> Sequence[str]:
    """`addresses`. Raises TypeError or ValueError if they are none."""
    if isinstance(addresses, str):
        raise TypeError("addresses: a list of HOST:PORT, not one string")
    if not addresses:
        raise ValueError("addresses: empty")
    return addresses


def channel(secure: Callable[..., Any], insecure: Callable[..., Any], service: str, addresses: Sequence[str],
            credentials: Optional[grpc.ChannelCredentials], server_name: Optional[str], policy: str = "round_robin") -> Any:
    """A channel over all `addresses` whose health service says that `service` is served, in turn."""
    addresses = check_addresses(addresses)
    # One address may be a name with many servers behind it: dns:///traverse-headless:50051.
    target = addresses[0] if len(addresses) == 1 else "ipv4:" + ",".join(addresses)
    config = {"loadBalancingConfig": [{policy: {}}], "healthCheckConfig": {"serviceName": service}}
    options: List[Tuple[str, Any]] = [("grpc.service_config", json.dumps(config)), ("grpc.keepalive_time_ms", 60_000),
                                      ("grpc.http2.max_pings_without_data", 0),  # a search may take long; else two
                                      ("grpc.max_reconnect_backoff_ms", 2_000)]
    if server_name:
        options.append(("grpc.ssl_target_name_override", server_name))
    return secure(target, credentials, options) if credentials else insecure(target, options)


def channels_one_by_one(secure: Callable[..., Any], insecure: Callable[..., Any], service: str, addresses: Sequence[str],
                        credentials: Optional[grpc.ChannelCredentials], server_name: Optional[str]) -> List[Any]:
    """A channel to each of `addresses`, for calls that belong together, in an order of chance. A name with many servers
    behind it is one of them, as long as the connection holds."""
    made = [channel(secure, insecure, service, [address], credentials, server_name, "pick_first")
            for address in check_addresses(addresses)]
    random.shuffle(made)  # so that clients spread
    return made


def authorization(token: Optional[Token]) -> Optional[Tuple[Tuple[str, str]]]:
    """The metadata of a call; a function is asked for each call, so that a token may be renewed."""
    if token is None:
        return None
    return (("authorization", "Bearer " + (token() if callable(token) else token)),)
