"""Names of aircraft in callsigns: makers, models, and nationality marks."""

MAKERS = frozenset({
    "aerocommander", "aeronca", "aerostar", "agusta", "airtractor", "apache", "archer", "arrow",
    "astra", "aviat", "aztec", "baron", "beaver", "beech", "beechcraft", "beechjet", "bell",
    "bellanca", "blackhawk", "bombardier", "bonanza", "brasilia", "caravan", "cardinal",
    "centurion", "cessna", "challenger", "champ", "cherokee", "chieftain", "chinook",
    "chipmunk", "cirrus", "citabria", "citation", "cobra", "columbia", "comanche", "commander",
    "conquest", "corvalis", "cougar", "crusader", "cub", "dakota", "decathlon", "denali",
    "diamond", "diamondstar", "diamondtwinstar", "duchess", "duke", "eclipse", "embraer",
    "epic", "ercoupe", "eurocopter", "evektor", "experimental", "extra", "falcon", "glasair",
    "glastar", "glider", "globalexpress", "grumman", "gulfstream", "gyrocopter", "hawker",
    "helicopter", "hondajet", "husky", "icon", "jabiru", "jetprop", "jetranger", "jetstream",
    "kingair", "kitfox", "lake", "lancair", "lance", "lear", "learjet", "legacy", "liberty",
    "lightsport", "longeze", "longranger", "luscombe", "malibu", "maule", "maverick",
    "meridian", "merlin", "metro", "mirage", "mitsubishi", "mooney", "musketeer", "mustang",
    "navajo", "navion", "otter", "pacer", "phenom", "pilatus", "piper", "pitts", "porter",
    "praetor", "premier", "provider", "queenair", "robin", "robinson", "sabreliner", "saratoga",
    "seminole", "seneca", "sikorsky", "skycatcher", "skyhawk", "skylane", "skymaster",
    "skywagon", "sling", "socata", "sonex", "sportcruiser", "sportcub", "stationair",
    "stearman", "sundowner", "supercub", "swearingen", "taylorcraft", "tecnam", "tiger",
    "titan", "tobago", "tomahawk", "travelair", "traveler", "trinidad", "tripacer", "twinbeech",
    "twincessna", "twincomanche", "twinotter", "twinstar", "vans", "velocity", "visionjet",
    "warrior", "westwind",
})  # fmt: skip
"""Makers and models, joined, that stand before the signs of a registration (FAA AIM 4-2-4; ICAO
Annex 10 volume II, 5.2.1.7.2.1). The names are from FAA Order JO 7360.1."""
NATIONALITY_MARKS = (
    "AP", "A2", "A3", "A4O", "A5", "A6", "A7", "A8", "A9C", "B", "C", "CC", "CF", "CN", "CP",
    "CS", "CU", "CX", "C2", "C3", "C5", "C6", "C9", "D", "DQ", "D2", "D4", "D6", "EC", "EI",
    "EJ", "EK", "EL", "EP", "ER", "ES", "ET", "EW", "EX", "EY", "EZ", "E3", "E5", "E7", "F",
    "G", "HA", "HB", "HC", "HH", "HI", "HK", "HL", "HP", "HR", "HS", "HV", "HZ", "H4", "I",
    "JA", "JU", "JY", "J2", "J3", "J5", "J6", "J7", "J8", "LN", "LV", "LX", "LY", "LZ", "M",
    "N", "OB", "OD", "OE", "OH", "OK", "OM", "OO", "OY", "PH", "PJ", "PK", "PP", "PR", "PS",
    "PT", "PU", "PZ", "P2", "P4", "RA", "RDPL", "RF", "RP", "SE", "SN", "SP", "ST", "SU", "SX",
    "S2", "S5", "S7", "S9", "TC", "TF", "TG", "TI", "TJ", "TL", "TN", "TR", "TS", "TT", "TU",
    "TY", "TZ", "T7", "T8A", "T9", "UK", "UN", "UP", "UR", "VH", "VN", "VP", "VQ", "VT", "V2",
    "V3", "V4", "V5", "V6", "V7", "V8", "XA", "XB", "XC", "XT", "XU", "XY", "XZ", "YA", "YI",
    "YJ", "YK", "YL", "YN", "YR", "YS", "YU", "YV", "Z", "ZA", "ZJ", "ZK", "ZP", "ZS", "ZT",
    "ZU", "Z3", "Z8", "2", "3A", "3B", "3C", "3D", "3X", "4K", "4L", "4O", "4R", "4X", "5A",
    "5B", "5H", "5N", "5R", "5T", "5U", "5V", "5W", "5X", "5Y", "6O", "6V", "6W", "6Y", "7O",
    "7P", "7Q", "7T", "8P", "8Q", "8R", "9A", "9G", "9H", "9J", "9K", "9L", "9M", "9N", "9Q",
    "9S", "9T", "9U", "9V", "9XR", "9Y",
)  # fmt: skip
"""Nationality and common marks (ICAO Annex 7, supplement)."""
