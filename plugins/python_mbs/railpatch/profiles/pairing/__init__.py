"""A pair of profiles: where wheel and rail touch, equivalent conicity, their page and command.

Above the contact and the pages, which the readers of profiles are below.
"""
