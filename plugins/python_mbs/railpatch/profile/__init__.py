"""The page on a profile, alone and together with a partner: ``railpatch profile``."""

from railpatch.profile.page import write_profile_page

__all__ = ["write_profile_page"]
