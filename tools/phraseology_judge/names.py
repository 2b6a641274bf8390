"""Names on the air: airlines, aircraft types, fixes, facilities, airports.

The designators and telephonies of airlines are those of ICAO Doc 8585. Many names contain words of
the phraseology ("lander" and "land", "clear lake" and "cleared"), as names on charts do.
"""

from __future__ import annotations

AIRLINES = dict(
    entry.split("=")
    for entry in (
        "AAL=american|UAL=united|DAL=delta|SWA=southwest|JBU=jetblue|ASA=alaska|NKS=spirit wings|"
        "FFT=frontier flight|HAL=hawaiian|AAY=allegiant|SCX=sun country|MXY=moxy|VXP=avelo|"
        "SKW=skywest|ENY=envoy|RPA=brickyard|EDV=endeavor|JIA=blue streak|PDT=piedmont|"
        "ASH=air shuttle|GJS=lindbergh|UCA=commutair|AWI=wisconsin|QXE=horizon air|KAP=cair|"
        "FDX=fedex|UPS=u p s|GTI=giant|ABX=abex|ATN=air transport|CKS=connie|NCR=national cargo|"
        "EJA=execjet|LXJ=flexjet|WUP=up jet|EJM=jet speed|TIV=thrive|ACA=air canada|ROU=rouge|"
        "JZA=jazz|WJA=westjet|WEN=encore|POE=porter|TSC=air transat|FLE=flair|AMX=aeromexico|"
        "VOI=volaris|VIV=aeroenlaces|CMP=copa|AVA=avianca|TAM=tam|LAN=lan chile|GLO=gol transporte|"
        "AZU=azul|ARG=argentina|BAW=speedbird|SHT=shuttle|VIR=virgin|EZY=easy|EXS=channex|"
        "TOM=tom jet|LOG=logan|EIN=shamrock|STK=stobart|RYR=ryanair|AFR=air frans|HOP=air hop|"
        "KLM=k l m|KLC=city|TRA=transavia|DLH=lufthansa|CLH=hansaline|EWG=eurowings|CFG=condor|"
        "GEC=lufthansa cargo|AUA=austrian|SWR=swiss|EDW=edelweiss|BEL=beeline|TAP=air portugal|"
        "IBE=iberia|VLG=vueling|AEA=europa|ITY=itarrow|SAS=scandinavian|NAX=nor shuttle|"
        "FIN=finnair|ICE=iceair|LOT=lot|CSA=c s a|WZZ=wizzair|ROT=tarom|AEE=aegean|THY=turkish|"
        "PGT=sunturk|ELY=elal|UAE=emirates|ETD=etihad|QTR=qatari|SVA=saudia|KAC=kuwaiti|"
        "GFA=gulf air|OMA=oman air|RJA=jordanian|MEA=cedar jet|MSR=egyptair|ETH=ethiopian|"
        "KQA=kenya|SAA=springbok|RAM=royalair maroc|DAH=air algerie|AIC=airindia|IGO=ifly|"
        "PIA=pakistan|ALK=srilankan|THA=thai|SIA=singapore|MAS=malaysian|AXM=red cap|"
        "GIA=indonesia|PAL=philippine|CEB=cebu|HVN=vietnam airlines|CPA=cathay|CRK=bauhinia|"
        "CCA=air china|CES=china eastern|CSN=china southern|CAL=dynasty|EVA=eva|JAL=japan air|"
        "ANA=all nippon|KAL=korean air|AAR=asiana|QFA=qantas|JST=jetstar|VOZ=velocity|"
        "ANZ=new zealand|FJI=fiji|CLX=cargolux|BOX=german cargo|TAY=quality|DHK=world express"
    ).split("|")
)
"""Telephonies of airlines by their designators."""
TYPES_OF_GENERAL_AVIATION = (
    "cessna|skyhawk|skylane|cherokee|archer|warrior|bonanza|baron|cirrus|mooney|king air|"
    "citation|learjet|gulfstream|diamond star|seneca|helicopter|pilatus|phenom|grumman"
).split("|")
TRAFFIC_TYPES = (
    "boeing seven thirty seven|airbus three twenty|seven three seven|cessna one seventy two|"
    "citation|king air|heavy boeing triple seven|embraer one seventy five|regional jet|dash eight|"
    "skyhawk|a three eighty|cherokee|gulfstream|helicopter|crj|md eleven|atr seventy two"
).split("|")
FIXES = (
    "deer park|cross city|lander|holston mountain|clear lake|winder|turner|miles city|two rivers|"
    "nine mile|ten sleep|hector|bravo|left bank|right fork|speedway|victor ville|golf mill|"
    "merit|camrn|robbinsville|calverton|solberg|sparta|huguenot|dixie|white|coate|gayel|neion|"
    "biggy|lanna|parkr|zeebo|bosun|lambourne|bovingdon|ockham|biggin|daventry|wallasey|pole hill|"
    "compton|midhurst|goodwood|berry head|honiley|abbeville|boulogne|rekken|spy|artip|river|"
    "sugol|gulli|temax|waypoint bravo|fort wayne|traverse city|gopher|fort dodge|crossville|"
    "waterloo|pocket city|armel|linden|gordonsville|casanova|montebello|beckley|front royal"
).split("|")
"""Names of navaids and waypoints."""
CITIES = (
    "boston|new york|potomac|chicago|cleveland|denver|seattle|miami|houston|albuquerque|memphis|"
    "norcal|socal|cross city|clearwater|charlie brown|land o lakes|climax|traverse city|holdrege|"
    "line creek|three rivers|romeo|london|scottish|shannon|paris|reims|langen|rhein|munich|zurich|"
    "geneva|milano|madrid|lisboa|maastricht|copenhagen|stockholm|helsinki|athens|ankara|dubai|"
    "mumbai|singapore|hong kong|tokyo|sydney|auckland|johannesburg|nairobi|toronto|santiago"
).split("|")
AIRPORTS = (
    "kennedy|la guardia|newark|teterboro|logan|dulles|reagan|o'hare|midway|hartsfield|sea tac|"
    "heathrow|gatwick|manchester|frankfurt|schiphol|dublin|palm springs|cross city|deer valley"
).split("|")
PROCEDURES = (
    "glen rose three|deer park four|hasty two|anjll five|gopher one|wynde three|crossings two|"
    "climer seven|bayst one|lander two|ruudy six|jaike three"
).split("|")
"""Names of departures and arrivals; no trap is meant by the numbers, charts have them."""
TAXIWAYS = "A B C D E F G H J K L M N P Q R S T U V W Y Z A1 B4 C3 D6 E2 K5 M10 W2".split()
RUNWAYS = (
    "01 04L 04R 05 07 08L 08R 09 09L 09R 10 10C 12 13L 13R 15R 16L 16R 17 18L 19 19R 21 22L 22R "
    "24L 24R 25L 25R 27 27L 27R 28C 28R 30 31L 31R 32 33L 34C 34L 35 36 36R"
).split()
