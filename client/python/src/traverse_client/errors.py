"""The one error of this package."""

import grpc


class TraverseError(Exception):
    """A job or file that cannot be done.

    code: a grpc.StatusCode. INVALID_ARGUMENT: the job is at fault, `details` names the field. UNAVAILABLE,
    RESOURCE_EXHAUSTED: no server took it before the deadline. DEADLINE_EXCEEDED: no server was reached in time.
    UNAUTHENTICATED, PERMISSION_DENIED: the token or certificate is refused.
    details: what is wrong and where, in a sentence.
    """

    def __init__(self, code: grpc.StatusCode, details: str):
        super().__init__(f"{code.name}: {details}")
        self.code = code
        self.details = details
